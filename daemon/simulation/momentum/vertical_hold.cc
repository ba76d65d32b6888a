#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/momentum/vertical_com.h"

// What a filter learns of the weight from a body that keeps its T-pose, or stands still.
namespace footing::momentum {
namespace {

// Loads are steady that keep, smoothed, within a limit of their mean. A person who stood still on
// laboratory plates (OpenCap subject 4, static1, 5 s) had a scatter of 0.011 m/s2 about means of
// 0.3 s, which differed from each other by 0.002.
constexpr double kNearS = 0.05, kSteadyMps2 = 0.06, kSteadyS = 0.3;
// What a mean of steady loads is worth.
constexpr double kLevelSpreadMps2 = 0.01;
// More of the weight than this is not wrong but elsewhere: a foot stands beside the boards.
constexpr double kMostWrong = 0.15;
// A body that the loads accelerate has moved by this while they were steady, more than its posture.
constexpr double kMovedM = 0.02;
// Means of the same steady loads are all wrong by the same: one counts where it says so many times
// more than is known.
constexpr double kNewLevel = 2;
// The T-pose is kept by a posture that, smoothed, is off its mean by less.
constexpr double kHeldS = 0.1, kHeldM = 0.004;
// Time between looks at a body in its T-pose, and what its velocity and height are worth.
constexpr double kLookS = 0.2, kHoldMps = 0.01, kHoldM = 0.015;

}  // namespace

void VerticalCom::WatchLevel(double raw_mps2) {
  steady_.since_s += step_s_;
  steady_.near_mps2 += step_s_ / (kNearS + step_s_) * (raw_mps2 - steady_.near_mps2);
  if (std::abs(steady_.near_mps2 - steady_.mean_mps2) > kSteadyMps2) {
    steady_.since_s = 0;
    steady_.near_mps2 = raw_mps2;
  }
  steady_.mean_mps2 += step_s_ / (steady_.since_s + step_s_) * (raw_mps2 - steady_.mean_mps2);
}

void VerticalCom::FollowHold(double height_m) {
  if (!t_pose_.held) return;
  if (t_pose_.frames == 0) t_pose_.near_m = height_m;
  t_pose_.frames += 1;
  t_pose_.mean_m += (height_m - t_pose_.mean_m) / t_pose_.frames;
  t_pose_.near_m += step_s_ / (kHeldS + step_s_) * (height_m - t_pose_.near_m);
  t_pose_.held = std::abs(t_pose_.near_m - t_pose_.mean_m) < kHeldM;
}

bool VerticalCom::holds_t_pose() const {
  return t_pose_.held && posture_.anchors_s > 0 && steady_.since_s >= kSteadyS &&
         cop_.speed_mps < config_.still_cop_mps;
}

bool VerticalCom::IsWeight(double left_mps2) const {
  const double off_mps2 = std::abs(left_mps2);
  return 0.5 * off_mps2 * steady_.since_s * steady_.since_s > kMovedM &&
         off_mps2 < kMostWrong * kStandardGravityMps2;
}

void VerticalCom::LookAtTPose(const VerticalInput& input) {
  t_pose_.since_look_s += step_s_;
  if (t_pose_.since_look_s < kLookS) return;
  t_pose_.since_look_s = 0;
  const Filter::Row row = LevelRow(input);
  const Filter::Scalar known = filter_.Of(row);
  const double left_mps2 = steady_.mean_mps2 - known.mean;
  const bool wrong = std::abs(left_mps2) > kSteadyMps2;
  if (wrong && !IsWeight(left_mps2)) return;
  if (wrong || known.variance > std::pow(kNewLevel * kLevelSpreadMps2, 2)) {
    LearnLevel(row, steady_.mean_mps2, left_mps2, kLevelSpreadMps2);
  }
  filter_.Update(Filter::Row::Unit(1), 0, kHoldMps * kHoldMps);
  filter_.Update(Filter::Row::Unit(0), 0, kHoldM * kHoldM);
}

void VerticalCom::LookAtLevel(const VerticalInput& input) {
  const Filter::Row row = LevelRow(input);
  const double left_mps2 = level_mps2_ - filter_.Of(row).mean;
  const double limit_mps2 = config_.still_acceleration_mps2;
  if (std::abs(left_mps2) > limit_mps2 && IsWeight(left_mps2)) {
    LearnLevel(row, level_mps2_, left_mps2, limit_mps2);
  }
}

VerticalCom::Filter::Row VerticalCom::LevelRow(const VerticalInput& input) const {
  Filter::Row row = Filter::Row::Unit(2);
  for (int i = 0; i < VerticalInput::kGroups; ++i) {
    row(kGains + i) = input.load_n[static_cast<std::size_t>(i)] / mass_kg_;
  }
  row(kPlay) = -input.play / mass_kg_;
  return row;
}

void VerticalCom::LearnLevel(const Filter::Row& row, double level_mps2, double left_mps2,
                             double sd_mps2) {
  if (std::abs(left_mps2) > std::max(sd_mps2, kSteadyMps2)) {  // All that was known is in doubt.
    Filter::Matrix q = Filter::Matrix::Zero();
    q.block<VerticalInput::kGroups, VerticalInput::kGroups>(kGains, kGains)
        .setConstant(std::pow(left_mps2 / kStandardGravityMps2, 2));
    filter_.Predict(Filter::Matrix::Identity(), Filter::Vector::Zero(), q);
  }
  filter_.Update(row, level_mps2, sd_mps2 * sd_mps2);
}

}  // namespace footing::momentum
