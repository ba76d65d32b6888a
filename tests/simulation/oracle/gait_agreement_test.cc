#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/gait/controller.h"
#include "tests/simulation/oracle/articulated_body.h"
#include "tests/simulation/test_world.h"

namespace footing::oracle {
namespace {

using stream::Gait;

/// Criteria of a gait, over ten seconds that begin when its speed is reached.
struct Gaited {
  double speed_mps = 0;
  double apex_m = 0;  ///< Highest point of the COM.
  double steps = 0;
  double lowest_body_m = 10;
};

/// The same controller over either engine.
template <typename World>
Gaited Measure(World world, const biped::GaitCommand& command) {
  const biped::BipedParameters biped = test::Biped();
  const gait::Gains gains;
  const double leg_m = gait::StandingLength(biped, gains), step_s = world.step_s();
  std::array<double, physics::kJoints> joints{};
  joints[3] = joints[7] = leg_m - biped.leg_length_m;
  world.Reset({0, 0, leg_m + biped.foot_radius_m + biped.hip_below_body_com_m}, 0, joints);
  gait::GaitMemory memory = gait::Standing(0, 0);
  const int settled = 8000, end = 18000;
  Gaited seen;
  double start_m = 0;
  std::uint64_t start_steps = 0;
  for (int i = 0; i < end; ++i) {
    const biped::BodyState body = biped::Read(biped, world.Observe(), i * step_s);
    if (i == settled) {
      start_m = body.p_WC.x();
      start_steps = memory.steps;
    }
    if (i >= settled) seen.apex_m = std::max(seen.apex_m, body.p_WC.z());
    seen.lowest_body_m = std::min(seen.lowest_body_m, body.p_WB.z());
    world.Step(gait::Advance(body, biped, gains, command, nullptr, step_s, memory),
               Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(memory.gait, command.gait);
  seen.speed_mps = (world.Observe().p_WC.x() - start_m) / ((end - settled) * step_s);
  seen.steps = static_cast<double>(memory.steps - start_steps);
  return seen;
}

class SameGait : public testing::TestWithParam<biped::GaitCommand> {};

TEST_P(SameGait, IsSeenByBothEngines) {
  const biped::GaitCommand& command = GetParam();
  const Gaited ours = Measure(ArticulatedBiped(test::Biped()), command);
  const Gaited theirs = Measure(test::LevelWorld(), command);
  EXPECT_GT(ours.lowest_body_m, 0.55);
  EXPECT_GT(theirs.lowest_body_m, 0.55);
  EXPECT_NEAR(ours.speed_mps, theirs.speed_mps, 0.01 * std::max(1.0, command.speed_mps));
  EXPECT_NEAR(ours.apex_m, theirs.apex_m, 0.02 * theirs.apex_m);
  EXPECT_NEAR(ours.steps, theirs.steps, 1);  // There are 16 to 27.
  EXPECT_GT(theirs.steps, 10);
}

INSTANTIATE_TEST_SUITE_P(ArticulatedBody, SameGait,
                         testing::Values(biped::GaitCommand{Gait::kStep, 0, 0.2, 0},
                                         biped::GaitCommand{Gait::kWalk, 0.8, 0.2, 0},
                                         biped::GaitCommand{Gait::kRun, 2, 0.2, 0},
                                         biped::GaitCommand{Gait::kJump, 0.5, 0.2, 0}),
                         [](const auto& tested) { return std::string(Name(tested.param.gait)); });

}  // namespace
}  // namespace footing::oracle
