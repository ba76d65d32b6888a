#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"
#include "tests/simulation/test_world.h"

namespace footing::gait {
namespace {

using Eigen::Vector3d;

TEST(AngularMomentum, OfABodyThatTurnsAsOneIsItsInertiaTimesItsRate) {
  const biped::BipedParameters biped = test::Biped();
  biped::BodyState body;
  const double hip_link_m = biped.hip_link_com_below_hip_m, half_m = biped.hip_half_spacing_m;
  const double length_m = 1.0, knee_link_m = length_m - biped.foot_below_knee_link_com_m;
  const double depth_m = 2 * (hip_link_m + knee_link_m) * biped.link_mass_kg / biped.mass_kg();
  const double roll_radps = 0.7;
  body.w_WB = {roll_radps, 0, 0};
  body.p_WC = {0, 0, -depth_m};
  body.v_WC = body.w_WB.cross(body.p_WC);
  for (int i = 0; i < 2; ++i) {
    body.legs[i].p_WH = {0, biped::Side(i) * half_m, 0};
    body.legs[i].length_m = length_m;
  }
  // Parallel axes: four links at the hips' spacing, at their depths below the whole COM.
  double inertia_kgm2 = biped.body_inertia_roll_kgm2 + biped.body_mass_kg * depth_m * depth_m;
  for (const double below_m : {hip_link_m, knee_link_m}) {
    const double arm_m = below_m - depth_m;
    inertia_kgm2 += 2 * (biped.link_inertia_across_kgm2 +
                         biped.link_mass_kg * (half_m * half_m + arm_m * arm_m));
  }
  EXPECT_NEAR(AngularMomentum(body, biped).x(), inertia_kgm2 * roll_radps, 1e-12);
}

TEST(AngularMomentum, StaysInFlightWhateverTheLegsDo) {
  biped::BipedParameters biped = test::Biped();
  biped.hip_armature_kgm2 = 0;  // The rotors' own momentum is left out.
  const char* plane = "<geom type='plane' contype='1' conaffinity='2' size='0 0 1'/>";
  physics::World world = std::move(physics::World::FromMjcf(
                                       biped::WriteMjcf(biped, plane, {}, 0.0002), biped::Names()))
                             .value();
  world.Reset({0, 0, 8}, 0, {});
  const auto momentum = [&] {
    return AngularMomentum(biped::Read(biped, world.Observe(), 0), biped);
  };
  for (int i = 0; i < 500; ++i) world.Step({}, {30, 60, 0});  // Above the whole COM: it turns.
  const Vector3d before = momentum();
  EXPECT_LT(before.x(), -0.3);
  for (int i = 0; i < 750; ++i) world.Step({0, 12, -8, 10, 0, -8, 6, -10}, Vector3d::Zero());
  EXPECT_LT((momentum() - before).norm(), 0.01 * before.norm());
  EXPECT_GT(std::fabs(world.Observe().joint_position[1]), 0.1);
}

using stream::Gait;

/// Steps a second from 4 s after the command on, over 6 s; 0 after a fall.
double MeasuredCadence(const biped::GaitCommand& command) {
  const biped::BipedParameters biped = test::Biped();
  const Gains gains;
  physics::World world = test::LevelWorld();
  const double leg_m = StandingLength(biped, gains), step_s = world.step_s();
  std::array<double, physics::kJoints> joints{};
  joints[3] = joints[7] = leg_m - biped.leg_length_m;
  world.Reset({0, 0, leg_m + biped.foot_radius_m}, 0, joints);
  GaitMemory memory = Standing(0, 0);
  double first_s = 0, last_s = 0;
  std::uint64_t first = 0, last = 0;
  for (int i = 0; i < 10000; ++i) {
    const biped::BodyState body = biped::Read(biped, world.Observe(), i * step_s);
    if (body.p_WB.z() < 0.55) return 0;
    // A kick of 2 N s to the side: a gait that only keeps its balance undisturbed does not count.
    const Eigen::Vector3d push_W_n(0, i >= 3000 && i < 3100 ? 20 : 0, 0);
    world.Step(Advance(body, biped, gains, command, nullptr, step_s, memory), push_W_n);
    if (i < 4000 || memory.steps == last) continue;
    last = memory.steps;
    last_s = i * step_s;
    if (first_s == 0) first = last, first_s = last_s;
  }
  return static_cast<double>(last - first) / (last_s - first_s);
}

TEST(Cadence, WalkingStepsAtTheUsersRate) {
  for (const double cadence_hz : {2.3, 2.6, 2.9}) {
    const biped::GaitCommand command{
        .gait = Gait::kWalk, .speed_mps = 0.8, .cadence_hz = cadence_hz};
    EXPECT_NEAR(MeasuredCadence(command), cadence_hz, 0.05 * cadence_hz);
  }
}

TEST(Cadence, RunningStepsAtTheUsersRate) {
  for (const double cadence_hz : {2.1, 2.3, 2.5}) {
    const biped::GaitCommand command{
        .gait = Gait::kRun, .speed_mps = 2.5, .cadence_hz = cadence_hz};
    EXPECT_NEAR(MeasuredCadence(command), cadence_hz, 0.05 * cadence_hz);
  }
}

TEST(Cadence, BeyondTheRobustRangeItIsFollowedAsFarAsThat) {
  const biped::GaitCommand hasty{.gait = Gait::kWalk, .speed_mps = 0.8, .cadence_hz = 9};
  const Gains gains;
  const double fastest_hz =
      1 / (gains.cadence.swing_time_min_s + gains.walking.double_support_time_s);
  EXPECT_NEAR(MeasuredCadence(hasty), fastest_hz, 0.05 * fastest_hz);
}

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
