#include "daemon/simulation/gait/momentum.h"

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

/// Sums what acts on the whole body and compares it with what its momentum does: a force that no
/// contact accounts for would show, however it was applied.
void ExpectOnlyContactAndGravity(const biped::GaitCommand& command) {
  const biped::BipedParameters biped = test::Biped();
  const Gains gains;
  physics::World world = test::LevelWorld();
  const double leg_m = StandingLength(biped, gains), step_s = world.step_s();
  std::array<double, physics::kJoints> joints{};
  joints[3] = joints[7] = leg_m - biped.leg_length_m;
  world.Reset({0, 0, leg_m + biped.foot_radius_m}, 0, joints);
  GaitMemory memory = Standing(0, 0);
  Eigen::Vector3d impulse_ns = Eigen::Vector3d::Zero();
  const int steps = 8000;
  double largest_ns = 0;
  for (int i = 0; i < steps; ++i) {
    const biped::BodyState body = biped::Read(biped, world.Observe(), i * step_s);
    world.Step(Advance(body, biped, gains, command, nullptr, step_s, memory),
               Eigen::Vector3d::Zero());
    const Eigen::Vector3d gravity_n(0, 0, -kStandardGravityMps2 * world.mass_kg());
    impulse_ns += step_s * (world.Observe().contact_force_W_n + gravity_n);
    const Eigen::Vector3d missing = world.mass_kg() * world.Observe().v_WC - impulse_ns;
    largest_ns = std::max(largest_ns, missing.norm());
  }
  EXPECT_EQ(memory.gait, command.gait);
  // 8 s of weight are 1020 N s; the integrator's error stays below a thousandth of it.
  EXPECT_LT(largest_ns, 1e-3 * steps * step_s * kStandardGravityMps2 * world.mass_kg());
  EXPECT_EQ(world.root_force_max_n(), 0);
}

TEST(Momentum, WalkingIsMovedByContactAndGravityAlone) {
  ExpectOnlyContactAndGravity({.gait = stream::Gait::kWalk, .speed_mps = 1});
}

TEST(Momentum, RunningIsMovedByContactAndGravityAlone) {
  ExpectOnlyContactAndGravity({.gait = stream::Gait::kRun, .speed_mps = 2});
}

TEST(Momentum, JumpingIsMovedByContactAndGravityAlone) {
  ExpectOnlyContactAndGravity({.gait = stream::Gait::kJump, .speed_mps = 0.5, .height_m = 0.3});
}

/// Efforts between links and gravity leave the angular momentum about the COM alone.
TEST(Momentum, AngularMomentumStaysInFreeFlightWhateverTheJointsDo) {
  const biped::BipedParameters biped = test::Biped();
  physics::World world = test::LevelWorld();
  world.Reset({0, 0, 5}, 0.3, {0.1, -0.2, 0.4, -0.1, 0, 0.1, -0.5, 0.05});
  const physics::JointEfforts efforts{0, 8, -12, 20, 0, -5, 15, -20};
  const auto seen = [&] { return biped::Read(biped, world.Observe(), 0); };
  world.Step(efforts, {300, 200, 0});
  const Eigen::Vector3d before = AngularMomentum(seen(), biped);
  double swing = 0;
  for (int i = 0; i < 100; ++i) {
    world.Step(efforts, Eigen::Vector3d::Zero());
    swing = std::max(swing, LegsMomentum(seen(), biped).norm());
  }
  EXPECT_GT(swing, 0.5);
  // Not 0: the hips' rotors (0.01 kg m2 at up to 10 rad/s) are seen by their joints alone.
  EXPECT_LT((AngularMomentum(seen(), biped) - before).norm(), 0.15 * swing);
}

}  // namespace
}  // namespace footing::gait
