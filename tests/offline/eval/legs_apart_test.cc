#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::eval {
namespace {

constexpr double kPushNs = 2.5;

/// Directions of pushes: the first one, and from each to the next, rad.
struct Directions {
  double first_rad, next_rad;
};
constexpr Directions kAllSides{0, 2.4};
constexpr Directions kLeftAndRight{kPi / 2, kPi};

/// Least gap between the legs of a gait that is pushed lightly every 0.9 s, at all times of its
/// cycle.
double LeastGap(const biped::GaitCommand& command, const Directions& pushes, double seconds) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return -INFINITY;
  constexpr double kSettledS = 4, kBetweenS = 0.9;
  Walker walker(*engine);
  walker.Command(biped::Limited(command));
  int pushed = 0;
  double time_s = 0;
  while (time_s < seconds) {
    if (time_s > kSettledS + kBetweenS * pushed) {
      walker.Push(kPushNs, pushes.first_rad + pushes.next_rad * pushed++);
    }
    time_s = walker.Advance().time_s;
  }
  EXPECT_FALSE(walker.fell());
  return walker.leg_gap_min_m();
}

TEST(LegsApart, ARunThroughACurveKeepsItsLegsBesideEachOther) {
  for (const double turn_deg : {5, -5}) {
    const double gap_m = LeastGap({.gait = stream::Gait::kRun,
                                   .speed_mps = 6,
                                   .turn_per_step_rad = DegreesToRadians(turn_deg)},
                                  kAllSides, 22);
    EXPECT_GT(gap_m, 0) << turn_deg;
  }
}

TEST(LegsApart, SteppingInPlaceIsPushedAsideWithoutItsFeetMeeting) {
  EXPECT_GT(LeastGap({.gait = stream::Gait::kStep}, kLeftAndRight, 20), 0);
}

}  // namespace
}  // namespace footing::eval
