#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/simulation/oracle/articulated_body.h"
#include "tests/simulation/test_world.h"

namespace footing::oracle {
namespace {

using Eigen::Vector3d;

const Vector3d kStart(0.3, -0.2, 20);
const Vector3d kVelocity(1.5, -0.4, 2);
const Vector3d kTurning(0.8, -1.1, 0.6);
constexpr std::array<double, physics::kJoints> kJointStart{0.1,  -0.2, 0.3, -0.1,
                                                           -0.3, 0.15, 0.2, -0.2};
constexpr std::array<double, physics::kJoints> kJointRate{0.5,  -0.7, 1.0, 0.1,
                                                          -0.4, 0.6,  0.3, -0.1};

/// Efforts that swing every joint about its start, each at its own frequency: servos, so that no
/// knee reaches its stop, which the oracle does not have.
physics::JointEfforts Wriggle(double time_s, const physics::Observation& seen) {
  physics::JointEfforts efforts{};
  for (int j = 0; j < physics::kJoints; ++j) {
    const bool knee = j % 4 == 3, yaw = j % 4 == 0;
    const double target = kJointStart[j] + (knee ? 0.08 : 0.4) * std::sin((7 + 1.3 * j) * time_s);
    const double stiffness = knee ? 600 : yaw ? 3 : 40, damping = knee ? 15 : yaw ? 0.1 : 2;
    efforts[j] = stiffness * (target - seen.joint_position[j]) - damping * seen.joint_velocity[j];
  }
  return efforts;
}

ArticulatedBiped FlyingOracle(double step_s = 0.001) {
  ArticulatedBiped oracle(test::Biped(), step_s);
  oracle.Reset(kStart, 0, kJointStart);
  oracle.SetVelocity(kVelocity, kTurning, kJointRate);
  return oracle;
}

physics::World FlyingWorld() {
  physics::World world = test::LevelWorld();
  world.Reset(kStart, 0, kJointStart);
  physics::WorldState state = world.Save();
  std::copy_n(kVelocity.data(), 3, state.qvel.begin());
  std::copy_n(kTurning.data(), 3, state.qvel.begin() + 3);  // Body's frame, at first the world's.
  std::copy_n(kJointRate.begin(), physics::kJoints, state.qvel.begin() + 6);
  world.Restore(state);
  return world;
}

TEST(FreeFlight, BothEnginesAgreeAfterASecondUnderTheSameEfforts) {
  ArticulatedBiped oracle = FlyingOracle();
  physics::World world = FlyingWorld();
  for (int i = 0; i < 1000; ++i) {
    const physics::JointEfforts efforts = Wriggle(i * 0.001, oracle.Observe());
    const Vector3d push_W_n = i < 100 ? Vector3d(20, -30, 5) : Vector3d::Zero();
    oracle.Step(efforts, push_W_n);
    world.Step(efforts, push_W_n);
  }
  const physics::Observation &ours = oracle.Observe(), &theirs = world.Observe();
  // Same equations, same integrator: what differs is rounding, which the swinging legs amplify.
  constexpr double kTolerance = 1e-6;
  EXPECT_LT((ours.p_WB - theirs.p_WB).norm(), kTolerance);
  EXPECT_LT((ours.v_WB - theirs.v_WB).norm(), kTolerance);
  EXPECT_LT((ours.R_WB - theirs.R_WB).norm(), kTolerance);
  EXPECT_LT((ours.w_WB - theirs.w_WB).norm(), kTolerance);
  EXPECT_LT((ours.p_WC - theirs.p_WC).norm(), kTolerance);
  EXPECT_LT((ours.v_WC - theirs.v_WC).norm(), kTolerance);
  for (int j = 0; j < physics::kJoints; ++j) {
    EXPECT_NEAR(ours.joint_position[j], theirs.joint_position[j], kTolerance) << "joint " << j;
    EXPECT_NEAR(ours.joint_velocity[j], theirs.joint_velocity[j], kTolerance) << "joint " << j;
    EXPECT_GT(std::fabs(ours.joint_position[j] - kJointStart[j]), 1e-3) << "joint " << j;
  }
  for (int leg = 0; leg < physics::kLegs; ++leg) {
    EXPECT_LT((ours.p_WF[leg] - theirs.p_WF[leg]).norm(), kTolerance);
  }
}

/// Loss of linear and angular momentum in a second of flight, and of energy without efforts.
struct Lost {
  double linear_mps, angular_kgm2ps, energy_j;
};

Lost Fly(double step_s, bool efforts) {
  ArticulatedBiped oracle = FlyingOracle(step_s);
  const Vector3d v_WC = oracle.Observe().v_WC, angular = oracle.AngularMomentum();
  const double energy_j = oracle.Energy();
  const auto steps = static_cast<int>(std::lround(1 / step_s));
  for (int i = 0; i < steps; ++i) {
    oracle.Step(efforts ? Wriggle(i * step_s, oracle.Observe()) : physics::JointEfforts{},
                Vector3d::Zero());
  }
  const Vector3d expected_v_WC = v_WC - Vector3d(0, 0, kStandardGravityMps2);
  return {(oracle.Observe().v_WC - expected_v_WC).norm(),
          (oracle.AngularMomentum() - angular).norm(), std::fabs(oracle.Energy() - energy_j)};
}

TEST(FreeFlight, TheOracleKeepsMomentumWhateverTheJointsDo) {
  const Lost lost = Fly(0.001, true);
  EXPECT_LT(lost.linear_mps, 0.01);
  EXPECT_LT(lost.angular_kgm2ps, 0.1);
  // The loss is the integrator's: a tenth of the step loses about a tenth.
  const Lost finer = Fly(0.0001, true);
  EXPECT_LT(finer.linear_mps, 0.2 * lost.linear_mps);
  EXPECT_LT(finer.angular_kgm2ps, 0.2 * lost.angular_kgm2ps);
}

TEST(FreeFlight, TheOracleKeepsEnergyWithoutEfforts) {
  const double lost_j = Fly(0.001, false).energy_j;
  // The fall itself loses m g^2 h / 2 = 0.63 J in a second of semi-implicit Euler.
  EXPECT_LT(lost_j, 1);
  EXPECT_LT(Fly(0.0001, false).energy_j, 0.2 * lost_j);
}

}  // namespace
}  // namespace footing::oracle
