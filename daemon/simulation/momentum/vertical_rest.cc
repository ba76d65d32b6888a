#include <algorithm>
#include <cmath>

#include "daemon/simulation/momentum/vertical_com.h"

// A filter that integrates the loads from rest to rest, where postures show how high the body is.
namespace footing::momentum {
namespace {

// A body is calm that has nearly no acceleration, by the loads less what is known of them, and a
// COP that hardly moves. It rests when it is calm for `kCalmS` and, by the filter, still and as
// high as the posture shows; or when its loads are steady for `kRestSteadyS` and it is still by the
// filter, at any height that legs allow: hands that stay where they are do not show a squat. Its
// loads are steady for `kSureS` where it is not still by the filter: then the filter may be wrong.
constexpr double kCalmMps2 = 0.5, kCalmCopMps = 0.15, kCalmS = 0.15;
constexpr double kRestSteadyS = 0.3, kSureS = 1, kLowestRestM = -0.6;
// Squared Mahalanobis distances: of a velocity from zero at which the body is still, and at which
// it has left a rest of unknown height.
constexpr double kStillDistance2 = 4, kMovesDistance2 = 9;
// Evidence below which a way has not led to a rest.
constexpr double kFailed = -1;
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

VerticalCom::Fit VerticalCom::FitOfStillness(double wrong) const {
  const Filter::Scalar v = filter_.Of(Filter::Row::Unit(1));
  const double variance = v.variance + kRestMps * kRestMps + wrong * wrong;
  const double distance2 = v.mean * v.mean / variance;
  return {distance2, -0.5 * (distance2 + std::log(variance))};
}

void VerticalCom::SeeRest(double height_m) {
  const bool calm = std::abs(acceleration_mps2_) < kCalmMps2 && cop_.speed_mps < kCalmCopMps;
  rest_.calm_s = calm ? rest_.calm_s + step_s_ : 0;
  const bool rested = rest_.rests;
  if (!rested) {
    ComeToRest(height_m);
  } else {
    // Of a rest of unknown height nothing but the velocity shows the end.
    rest_.rests = calm && (rest_.known || FitOfStillness(0).distance2 < kMovesDistance2);
  }
  if (rest_.rests) {
    LookAtRest(height_m);
    return;
  }
  const Filter::Scalar now = filter_.Of(Filter::Row::Unit(0));
  if (rested) rest_.lowest_m = rest_.highest_m = now.mean;
  rest_.away_s += step_s_;
  rest_.lowest_m = std::min(rest_.lowest_m, now.mean);
  rest_.highest_m = std::max(rest_.highest_m, now.mean);
  const double sure_m = kTooHighSpreads * std::sqrt(now.variance);
  if (Loaded(last_.raw_mps2) && now.mean - sure_m > std::max(height_m, 0.0) + kTiptoeM) {
    rest_.found = Return{};
  }
}

void VerticalCom::ComeToRest(double height_m) {
  const double steady_s = std::min(steady_.since_s, rest_.calm_s), z_m = filter_.x()(0);
  const bool back = rest_.calm_s >= kCalmS && FitOfRest(height_m, 0).distance2 < kBackDistance2;
  const bool still = steady_s >= kRestSteadyS && FitOfStillness(0).distance2 < kStillDistance2 &&
                     z_m > kLowestRestM && z_m < std::max(height_m, 0.0) + kTiptoeM;
  if (!back && !still && steady_s < kSureS) return;
  const double wrong = kWrongShare * (rest_.highest_m - rest_.lowest_m);
  const double evidence =
      back ? FitOfRest(height_m, 0).log_density - FitOfRest(height_m, wrong).log_density
           : FitOfStillness(0).log_density - FitOfStillness(wrong).log_density;
  rest_.rests = back || still;
  if (!rest_.rests && evidence > kFailed) return;
  rest_.found = Return{rest_.rests, follows_loads(), evidence};
  rest_.known = back;
  rest_.since_look_s = kRestLookS;
}

void VerticalCom::LookAtRest(double height_m) {
  rest_.away_s = 0;
  rest_.known = rest_.known || FitOfRest(height_m, 0).distance2 < kBackDistance2;
  rest_.since_look_s += step_s_;
  if (rest_.since_look_s < kRestLookS) return;
  rest_.since_look_s = 0;
  if (!rest_.known && FitOfStillness(0).distance2 > kStillDistance2) return;
  filter_.Update(Filter::Row::Unit(1), 0, kRestMps * kRestMps);
  if (!rest_.known) return;
  Filter::Row h = Filter::Row::Unit(0);
  h(kPosture) = 1;
  filter_.Update(h, height_m, kStandsWhiteM * kStandsWhiteM);
}

}  // namespace footing::momentum
