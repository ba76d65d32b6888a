#include "daemon/offline/eval/arm_bound.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::eval {
namespace {

// Attitudes of each device that count as alike, now and kBeforeS ago: with 10 degrees (0.17 rad)
// both times one frame in ten has a moment like it, with these one in two.
constexpr double kAlikeRad = 0.26, kAlikeBeforeRad = 0.7;
constexpr double kBeforeS = 0.3;
constexpr double kApartS = 2;  // Closer in time is the same moment.
constexpr ArmDistance kAims{8, 8, 6};

std::size_t Frames(double seconds, double rate_hz) {
  return static_cast<std::size_t>(std::lround(seconds * rate_hz));
}

double Squared(double x) { return x * x; }

}  // namespace

ArmDistance Distance(const arms::ArmGeometry& geometry, const arms::ArmDirections& a,
                     const arms::ArmDirections& b) {
  return {RadiansToDegrees(arms::ShoulderError(a, b)), RadiansToDegrees(arms::ElbowError(a, b)),
          100 * (geometry.Hand(a) - geometry.Hand(b)).norm()};
}

bool ArmBound::Alike(std::size_t a, std::size_t b, double most_rad) const {
  const double least_trace = 1 + 2 * std::cos(most_rad);
  for (std::size_t place = 0; place < arms::kPlaces; ++place) {
    if (!places_[place]) continue;
    const double trace = moments_[a].turns_W[place].cwiseProduct(moments_[b].turns_W[place]).sum();
    if (trace < least_trace) return false;
  }
  return true;
}

arms::ArmDirections ArmBound::Moved(const ArmMoment& other, const ArmMoment& now) const {
  const auto turn = [&](arms::Place nearest) {
    auto place = static_cast<std::size_t>(nearest);
    if (!places_[place]) place = static_cast<std::size_t>(arms::Place::kFist);
    return Eigen::Matrix3d(now.turns_W[place] * other.turns_W[place].transpose());
  };
  const Eigen::Matrix3d upper = turn(arms::Place::kUpperArm), forearm = turn(arms::Place::kForearm);
  return {upper * other.truth.upper, upper * other.truth.hinge, forearm * other.truth.forearm};
}

void ArmBound::AddFrame(std::size_t frame, Sums& sums) const {
  const std::size_t before = Frames(kBeforeS, rate_hz_), apart = Frames(kApartS, rate_hz_);
  ArmDistance sum;
  std::size_t count = 0;
  for (std::size_t other = before; other < moments_.size(); ++other) {
    if (other + apart > frame && other < frame + apart) continue;
    if (!Alike(frame, other, kAlikeRad) ||
        !Alike(frame - before, other - before, kAlikeBeforeRad)) {
      continue;
    }
    const ArmDistance off =
        Distance(geometry_, Moved(moments_[other], moments_[frame]), moments_[frame].truth);
    sum.shoulder_deg += off.shoulder_deg;
    sum.elbow_deg += off.elbow_deg;
    sum.hand_cm += Squared(off.hand_cm);
    ++count;
  }
  if (count == 0) return;
  const auto n = static_cast<double>(count);
  const ArmDistance least{sum.shoulder_deg / n / std::sqrt(2.0), sum.elbow_deg / n / std::sqrt(2.0),
                          std::sqrt(sum.hand_cm / n / 2)};
  const auto add = [](const ArmDistance& one, ArmDistance& all) {
    all.shoulder_deg += one.shoulder_deg;
    all.elbow_deg += one.elbow_deg;
    all.hand_cm += Squared(one.hand_cm);
  };
  ++sums.alike;
  add(least, sums.least);
  if (least.shoulder_deg > kAims.shoulder_deg || least.elbow_deg > kAims.elbow_deg ||
      least.hand_cm > kAims.hand_cm)
    return;
  ++sums.observable;
  add(moments_[frame].error, sums.error);
}

nlohmann::ordered_json ArmBound::Json(const std::vector<ArmBound>& arms) {
  Sums sums;
  std::size_t frames = 0;
  for (const ArmBound& arm : arms) {
    frames += arm.moments_.size();
    const std::size_t first = Frames(kBeforeS, arm.rate_hz_);
    for (std::size_t i = first; i < arm.moments_.size(); ++i) arm.AddFrame(i, sums);
  }
  const auto share = [](std::size_t part, std::size_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
  };
  const auto json = [](const ArmDistance& sum, std::size_t count) {
    const double n = count > 0 ? static_cast<double>(count) : 1;
    return nlohmann::ordered_json{{"shoulder_error_deg", sum.shoulder_deg / n},
                                  {"elbow_error_deg", sum.elbow_deg / n},
                                  {"hand_position_rms_cm", std::sqrt(sum.hand_cm / n)}};
  };
  nlohmann::ordered_json report = {{"alike_share", share(sums.alike, frames)}};
  report["least"] = json(sums.least, sums.alike);
  report["observable_share"] = share(sums.observable, sums.alike);
  report["in_observable"] = json(sums.error, sums.observable);
  return report;
}

}  // namespace footing::eval
