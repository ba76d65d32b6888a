#include "daemon/simulation/biped/limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::biped {
namespace {

using stream::Gait;

TEST(Limits, KeepCommandsInTheStableRange) {
  EXPECT_EQ(Limited({.gait = Gait::kWalk, .speed_mps = 9}).speed_mps, 1.75);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = -1}).speed_mps, 0);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .height_m = 3}).height_m, 0.7);
  EXPECT_EQ(Limited({.gait = Gait::kJump, .speed_mps = 2, .height_m = 3}).height_m, 0.5);
  EXPECT_EQ(Limited({.gait = Gait::kRun, .speed_mps = NAN}).gait, Gait::kStep);
  EXPECT_EQ(Limited({.gait = Gait::kUnspecified, .speed_mps = 1}).gait, Gait::kStep);
}

TEST(Limits, ALeapFasterThanJumpsAreTurnsLess) {
  EXPECT_DOUBLE_EQ(TurnLimit(Gait::kJump, 2), DegreesToRadians(kTurnPerStepMaxDeg));
  // The same sideways speed of the landing: 8 degrees at 2 m/s, 4 at 4.
  EXPECT_DOUBLE_EQ(TurnLimit(Gait::kJump, 4), DegreesToRadians(kTurnPerStepMaxDeg / 2));
}

TEST(Limits, AFasterRunTurnsLess) {
  const double slow_rad = TurnLimit(Gait::kRun, 3), fast_rad = TurnLimit(Gait::kRun, 6);
  EXPECT_DOUBLE_EQ(slow_rad, DegreesToRadians(kTurnPerStepMaxDeg));
  EXPECT_DOUBLE_EQ(fast_rad, DegreesToRadians(5));
  EXPECT_NEAR(TurnLimit(Gait::kRun, 5), (slow_rad + fast_rad) / 2, 1e-12);
  for (const double sign : {1.0, -1.0}) {
    const GaitCommand sharp{.gait = Gait::kRun, .speed_mps = 9, .turn_per_step_rad = sign};
    EXPECT_DOUBLE_EQ(Limited(sharp).turn_per_step_rad, sign * fast_rad);
  }
}

TEST(Limits, KeepWhatTheyDoNotLimit) {
  const GaitCommand command{.gait = Gait::kWalk,
                            .speed_mps = 1,
                            .height_m = 0.2,
                            .turn_per_step_rad = 0.05,
                            .cadence_hz = 2.5};
  EXPECT_EQ(Limited(command), command);
}

}  // namespace
}  // namespace footing::biped
