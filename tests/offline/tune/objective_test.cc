#include "daemon/offline/tune/objective.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::tune {
namespace {

constexpr Task kWalk{stream::Gait::kWalk, 1.0};

TrialResult AsWanted(const Task& task) {
  const Wanted wanted = WantedOf(task, 0.2);
  return {.survived = 1,
          .speed_error_mps = 0,
          .flight_s = wanted.flight_s,
          .stance_s = wanted.stance_s,
          .stride_m = wanted.stride_m};
}

TEST(Objective, IsNothingWhenAllIsAsWanted) {
  for (const Task& task : {kWalk, Task{stream::Gait::kStep, 0}, Task{stream::Gait::kRun, 3},
                           Task{stream::Gait::kJump, 0.5}}) {
    EXPECT_NEAR(CostOf(task, AsWanted(task)).total(), 0, 1e-12);
  }
}

TEST(Objective, ChargesTwentyForAFallAtOnceAndTenForTheLatest) {
  TrialResult result = AsWanted(kWalk);
  result.survived = 0;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).total(), 20);
  result.survived = 0.75;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).failure, 10 + 10 * 0.25);
}

TEST(Objective, ChargesTheLatestFallMoreThanAllElseTogether) {
  TrialResult worst{.survived = 1,
                    .speed_error_mps = 9,
                    .flight_s = 9,
                    .stance_s = 9,
                    .stride_m = 99,
                    .heading_error_rad = 3,
                    .leg_gap_m = -0.04};
  const Task run{stream::Gait::kRun, 3};
  TrialResult worst_change = worst;
  worst_change.heading_error_rad = 0;  // Of turns alone.
  worst_change.latency_s = 5;
  TrialResult fallen = AsWanted(run);
  fallen.survived = 0.9999;
  for (const TrialResult& bad : {worst, worst_change}) {
    const double all_else = CostOf(run, bad).total();
    EXPECT_GT(all_else, 8);
    EXPECT_GT(CostOf(run, fallen).total(), all_else);
  }
}

TEST(Objective, ChargesEachTermByItself) {
  TrialResult result = AsWanted(kWalk);
  result.speed_error_mps = 0.15;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).speed, 1);
  result.speed_error_mps = 5;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).speed, 2);
  result.flight_s *= 1.1;
  EXPECT_NEAR(CostOf(kWalk, result).flight, 0.25, 1e-12);
  result.stance_s *= 0.5;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).stance, 1);
  result.stride_m *= 1.2;
  EXPECT_NEAR(CostOf(kWalk, result).stride, 1, 1e-12);
  result.heading_error_rad = DegreesToRadians(2.5);
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).heading, 0.25);
}

TEST(Objective, ChargesTheLegsOfARunThatComeTooNear) {
  const Task run{stream::Gait::kRun, 3};
  TrialResult result = AsWanted(run);
  result.leg_gap_m = 0.03;
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 0);
  result.leg_gap_m = 0;
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 1);
  result.leg_gap_m = -0.04;  // One through the other.
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 2);
  // A walk steps across where balance asks for it.
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).legs, 0);
}

TEST(Objective, ChargesARunThatTakesLongToWalk) {
  const Task run{stream::Gait::kRun, 6};
  TrialResult result = AsWanted(run);
  result.latency_s = 1.2;  // 0.6 s + 0.1 s x 6.
  EXPECT_NEAR(CostOf(run, result).latency, 0, 1e-12);
  result.latency_s = 1.1 * 1.2;
  EXPECT_NEAR(CostOf(run, result).latency, 1, 1e-9);
  result.latency_s = 1.43;  // A hop more.
  EXPECT_DOUBLE_EQ(CostOf(run, result).latency, 2);
  result.latency_s = 0.5;  // Sooner is no fault.
  EXPECT_DOUBLE_EQ(CostOf(run, result).latency, 0);
}

TEST(Objective, DoesNotChargeWhatWasNeverSeen) {
  EXPECT_DOUBLE_EQ(CostOf(kWalk, TrialResult{}).total(), 0);
}

}  // namespace
}  // namespace footing::tune
