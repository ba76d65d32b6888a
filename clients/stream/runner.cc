#include "clients/stream/runner.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"

namespace footing::stream_client {
namespace {

constexpr double kPointEveryM = 0.25;
constexpr double kRememberedS = 1.5;
/// From a turn of the hands to a turn of the character, besides the reaction.
constexpr double kInterfaceS = 0.25;
/// Turning rate while both hands are inclined: 5 degrees a step (gait paper, section 7).
constexpr double kTurnPerStepRad = 5 * kPi / 180;
constexpr double kStepsPerS = 2.4;
/// What a player plans with of it.
constexpr double kTurnShare = 0.8;
constexpr double kSteerAboveRad = 0.08, kSteerBelowRad = 0.03;
/// Well above the 20 degrees at which the wrists turn.
constexpr double kInclinedRad = 30 * kPi / 180;
/// Frequencies over speeds, as the wrist interface maps them (its table of ranges).
constexpr double kWalkMps = 1.2, kWalkHz = 1.75, kWalkSlowMps = 0.6, kWalkSlowHz = 1.0;
constexpr double kRunSlowMps = 1.75, kRunSlowHz = 2.2, kRunMps = 3.0, kRunHz = 3.25;
constexpr double kWalkAmplitudeMps2 = 7, kRunAmplitudeMps2 = 13;
/// A walker wants a reason to run.
constexpr double kSlackMps = 0.25;

double Between(double x, double x0, double y0, double x1, double y1) {
  return y0 + (y1 - y0) * std::clamp((x - x0) / (x1 - x0), 0.0, 1.0);
}

}  // namespace

Runner::Runner(std::uint64_t seed) {
  noise::Random random(seed);
  reaction_s_ = random.Uniform(0.2, 0.3);
  favourite_mps_ = random.Uniform(2.2, 2.8);
}

void Runner::SeeTrack(const stream::Track& track) {
  line_.clear();
  for (const stream::TrackSegment& segment : track.segments) {
    const Eigen::Vector2d way(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
    for (double along_m = 0; along_m < segment.length_m; along_m += kPointEveryM) {
      line_.push_back({segment.start_m.head<2>() + along_m * way, segment.heading_rad});
    }
  }
}

void Runner::See(double time_s, const RunnerSight& sight) {
  seen_.push_back({time_s, sight});
  while (time_s - seen_.front().time_s > kRememberedS) seen_.pop_front();
}

/// Where the character will be when what the hands do now takes effect.
RunnerSight Runner::Reckon(double time_s) const {
  Seen old = seen_.front();
  for (const Seen& seen : seen_) {
    if (seen.time_s <= time_s - reaction_s_) old = seen;
  }
  RunnerSight now = old.sight;
  constexpr double kStepS = 0.05;
  for (double t_s = old.time_s; t_s < time_s + kInterfaceS; t_s += kStepS) {
    int side = 0;
    for (const Turned& turned : turned_) {
      if (turned.time_s + kInterfaceS <= t_s) side = turned.side;
    }
    now.heading_rad += side * kTurnPerStepRad * kStepsPerS * kStepS;
    now.p_W_m += now.speed_mps * kStepS *
                 Eigen::Vector2d(std::cos(now.heading_rad), std::sin(now.heading_rad));
  }
  return now;
}

std::size_t Runner::NearestTo(const Eigen::Vector2d& p_W_m) const {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < line_.size(); ++i) {
    if ((line_[i].p_W_m - p_W_m).squaredNorm() < (line_[nearest].p_W_m - p_W_m).squaredNorm()) {
      nearest = i;
    }
  }
  return nearest;
}

const Runner::Point& Runner::Ahead(std::size_t from, double ahead_m) const {
  const auto points = static_cast<std::size_t>(ahead_m / kPointEveryM);
  return line_[std::min(from + points, line_.size() - 1)];
}

/// The sharpest bend in sight, rad/m.
double Runner::BendAhead(std::size_t from, double speed_mps) const {
  constexpr double kSpanM = 3;
  double sharpest = 0;
  for (double ahead_m = 0; ahead_m < 3 + 2 * speed_mps; ahead_m += 0.5) {
    const double turn_rad =
        WrapAngle(Ahead(from, ahead_m + kSpanM).heading_rad - Ahead(from, ahead_m).heading_rad);
    sharpest = std::max(sharpest, std::fabs(turn_rad) / kSpanM);
  }
  return sharpest;
}

RunnerSwing Runner::Want(double time_s) {
  if (line_.empty() || seen_.empty()) return {};
  while (!turned_.empty() && time_s - turned_.front().time_s > kRememberedS) turned_.pop_front();
  const RunnerSight now = Reckon(time_s);
  const std::size_t here = NearestTo(now.p_W_m);
  const double speed_mps = std::max(0.0, now.speed_mps);
  const Eigen::Vector2d way = Ahead(here, std::clamp(1.2 + speed_mps, 2.0, 4.0)).p_W_m - now.p_W_m;
  const double error_rad = WrapAngle(std::atan2(way.y(), way.x()) - now.heading_rad);
  const bool steers = std::fabs(error_rad) > (side_ == 0 ? kSteerAboveRad : kSteerBelowRad);
  side_ = steers ? (error_rad > 0 ? 1 : -1) : 0;
  turned_.push_back({time_s, side_});

  const double rate_radps = kTurnShare * kTurnPerStepRad * kStepsPerS;
  const double bend = std::max(1e-3, BendAhead(here, speed_mps));
  const double most_mps = std::min(favourite_mps_, rate_radps / bend);
  runs_ = most_mps > kRunSlowMps + (runs_ ? 0 : kSlackMps);
  const double frequency_hz = runs_
                                  ? Between(most_mps, kRunSlowMps, kRunSlowHz, kRunMps, kRunHz)
                                  : Between(most_mps, kWalkSlowMps, kWalkSlowHz, kWalkMps, kWalkHz);
  return {frequency_hz, runs_ ? kRunAmplitudeMps2 : kWalkAmplitudeMps2, -side_ * kInclinedRad};
}

}  // namespace footing::stream_client
