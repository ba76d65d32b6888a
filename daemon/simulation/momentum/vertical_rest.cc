#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/vertical_com.h"

// A filter that integrates the loads from rest to rest, where postures show how high the body is.
namespace footing::momentum {
namespace {

// A body is calm that has nearly no acceleration, by the loads less what is known of them, and a
// COP that hardly moves. It rests when it is calm for `kCalmS` and back by the filter. If it is not
// back by the filter, it rests when it is calm for longer: with the posture of the last rest, to
// `kSamePostureM`, or with any posture that hardly moves.
constexpr double kCalmMps2 = 0.5, kCalmCopMps = 0.15, kCalmS = 0.15;
constexpr double kSamePostureM = 0.02, kSameCalmS = 0.3;
constexpr double kSlowPostureMps = 0.05, kSureCalmS = 0.5;
// The error of the height of a posture that stands: mean and standard deviation of what is the same
// at every rest, and standard deviation of the rest. Two people left out of the model stand 1 to 2
// cm too low in the mean.
constexpr double kStandsM = -0.015, kStandsSpreadM = 0.03, kStandsWhiteM = 0.01;
constexpr double kRestMps = 0.02;     // Standard deviation of the velocity of a body that rests.
constexpr double kRestLookS = 0.5;    // Time between independent looks at one rest.
constexpr double kBackDistance2 = 6;  // Squared Mahalanobis distance, of height and velocity.
// Wrong cells end a way too high or low, and too fast, by so much of its depth (m, and m/s).
constexpr double kWrongShare = 0.5;
// Doubt after a return that failed: of the weight, and of the height.
constexpr double kRestartGain = 0.005, kRestartM = 0.03;
constexpr double kTooHighSpreads = 3;
constexpr double kLongS = 1e3;

}  // namespace

double VerticalCom::PostureMean() const { return config_.by_rests ? kStandsM : 0; }

double VerticalCom::PostureSpread() const {
  return config_.by_rests ? kStandsSpreadM : config_.posture.spread_m;
}

void VerticalCom::LeaveRests() {
  rest_ = {};
  rest_.away_s = kLongS;
}

std::optional<Return> VerticalCom::TakeReturn() {
  const std::optional<Return> found = rest_.found;
  rest_.found.reset();
  return found;
}

void VerticalCom::RestartFrom(const VerticalCom& other) {
  Adopt(other);
  Filter::Vector x = filter_.x();
  Filter::Matrix p = filter_.p();
  x(kPosture) = kStandsM;
  p.row(kPosture).setZero();
  p.col(kPosture).setZero();
  p(kPosture, kPosture) = kStandsSpreadM * kStandsSpreadM;
  p(0, 0) += kRestartM * kRestartM;
  p.block<VerticalInput::kGroups, VerticalInput::kGroups>(kGains, kGains).array() +=
      kRestartGain * kRestartGain;
  filter_.Start(x, p);
  filter_.Remember(Filter::Row::Unit(0));
  LeaveRests();
}

VerticalCom::Fit VerticalCom::FitOfRest(double height_m, double wrong) const {
  Filter::Row h = Filter::Row::Unit(0);
  h(kPosture) = 1;
  const Filter::Row v = Filter::Row::Unit(1);
  const double off_m = height_m - h * filter_.x(), off_mps = -filter_.x()(1);
  const double a = filter_.Of(h).variance + kStandsWhiteM * kStandsWhiteM + wrong * wrong;
  const double b = filter_.Of(v).variance + kRestMps * kRestMps + wrong * wrong;
  const double c = h * filter_.p() * v.transpose(), det = a * b - c * c;
  const double distance2 =
      (b * off_m * off_m - 2 * c * off_m * off_mps + a * off_mps * off_mps) / det;
  return {distance2, -0.5 * (distance2 + std::log(det))};
}

void VerticalCom::SeeRest(double height_m) {
  const bool calm = std::abs(acceleration_mps2_) < kCalmMps2 && cop_.speed_mps < kCalmCopMps;
  rest_.calm_s = calm ? rest_.calm_s + step_s_ : 0;
  rest_.slow_s = std::abs(posture_.speed_mps) < kSlowPostureMps ? rest_.slow_s + step_s_ : 0;
  bool rests = calm;
  if (!rest_.rests) {
    const bool back = FitOfRest(height_m, 0).distance2 < kBackDistance2;
    const bool same = std::abs(height_m - rest_.posture_m) < kSamePostureM;
    rests = rest_.calm_s >= (back   ? kCalmS
                             : same ? kSameCalmS
                                    : kSureCalmS) &&
            (back || same || rest_.slow_s >= kSureCalmS);
  }
  if (rests) {
    ComeToRest(height_m);
    return;
  }
  const Filter::Scalar now = filter_.Of(Filter::Row::Unit(0));
  if (rest_.rests) {
    rest_.rests = false;
    rest_.left_m = rest_.lowest_m = now.mean;
  }
  rest_.away_s += step_s_;
  rest_.lowest_m = std::min(rest_.lowest_m, now.mean);
  const double sure_m = kTooHighSpreads * std::sqrt(now.variance);
  if (Loaded(last_.raw_mps2) && now.mean - sure_m > std::max(height_m, 0.0) + kTiptoeM) {
    rest_.found = Return{};
  }
}

void VerticalCom::ComeToRest(double height_m) {
  if (!rest_.rests) {
    const Fit fit = FitOfRest(height_m, 0);
    const double wrong = kWrongShare * (rest_.left_m - rest_.lowest_m);
    rest_.found = Return{fit.distance2 < kBackDistance2, follows_loads(),
                         fit.log_density - FitOfRest(height_m, wrong).log_density};
    rest_.rests = rest_.found->back;
    rest_.since_look_s = kRestLookS;
    if (!rest_.rests) return;
  }
  rest_.away_s = 0;
  rest_.posture_m = height_m;
  rest_.since_look_s += step_s_;
  if (rest_.since_look_s < kRestLookS) return;
  rest_.since_look_s = 0;
  Filter::Row h = Filter::Row::Unit(0);
  h(kPosture) = 1;
  filter_.Update(Filter::Row::Unit(1), 0, kRestMps * kRestMps);
  filter_.Update(h, height_m, kStandsWhiteM * kStandsWhiteM);
}

}  // namespace footing::momentum
