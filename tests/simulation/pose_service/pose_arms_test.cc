#include "daemon/simulation/pose_service/pose_arms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/wire/wire.h"

namespace footing::pose_service {
namespace {

constexpr std::uint32_t kLeft = 3, kRight = 4;
constexpr double kPeriodS = 0.01;

/// Forearm and upper arm go where the hand's axis goes that was along the arm in the T-pose.
arms::ArmModel StiffArm() {
  arms::ArmModel model;
  model.mean.setZero();
  model.scale.setOnes();
  model.weights.setZero(arms::kDirections, arms::ArmFeatures::kCount);
  model.offset.setZero();
  for (int k = 0; k < 3; ++k) {
    model.weights(k, 3 + k) = model.weights(6 + k, 3 + k) = 1;  // Second column of the turn.
    model.weights(3 + k, 6 + k) = 1;
  }
  model.covariance.setIdentity();
  model.covariance *= 0.04;
  return model;
}

/// Two Wiimotes, level and pointing forward, that turn about the axis ahead.
struct PoseArmsTest : testing::Test {
  PoseArmsTest() {
    arms.Bind(0, kLeft);
    arms.Bind(1, kRight);
  }

  /// A sample of a Wiimote: S is x left, y front, z down; ahead is its y.
  void Take(std::uint32_t device, double turn_radps) {
    v1::MotionSample sample;
    sample.set_device(device);
    sample.set_sampled_ns(now_ns);
    *sample.mutable_specific_force_mps2() = wire::ToProto(Eigen::Vector3d(
        kStandardGravityMps2 * std::sin(roll_rad), 0, -kStandardGravityMps2 * std::cos(roll_rad)));
    // Of what it reads, footingd has taken a part for its bias.
    *sample.mutable_angular_velocity_radps() =
        wire::ToProto(Eigen::Vector3d(kBiasRadps, turn_radps - held_bias_radps, 0));
    *sample.mutable_gyroscope_bias_radps() = wire::ToProto(Eigen::Vector3d(0, held_bias_radps, 0));
    arms.Take(sample, now_ns);
  }
  void Run(double seconds, double turn_radps, bool left_too = true) {
    for (double t_s = 0; t_s < seconds - 1e-9; t_s += kPeriodS) {
      now_ns += SecondsToNanoseconds(kPeriodS);
      roll_rad += turn_radps * kPeriodS;
      if (left_too) Take(kLeft, turn_radps);
      Take(kRight, turn_radps);
      arms.Report(now_ns, inputs);
    }
  }
  void TakeTPose() {
    arms.Follow(false, 0);
    Run(5, 0);
    arms.Follow(true, 1);
  }
  Eigen::Vector3d Forearm(std::size_t side) const {
    return inputs.sensors.arms[side].directions.forearm;
  }

  static constexpr double kBiasRadps = 0.02;
  double held_bias_radps = 0, roll_rad = 0;
  std::int64_t now_ns = 50'000'000'000;
  PoseArms arms{StiffArm()};
  PoseInputs inputs;
};

TEST_F(PoseArmsTest, ArmsAreToldFromTheTPoseOnAndGoWhereTheWiimotesTurn) {
  arms.Follow(false, 0);
  Run(5, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  arms.Follow(true, 1);
  Run(0.8, 1);
  ASSERT_TRUE(inputs.sensors.arms[0].valid && inputs.sensors.arms[1].valid);
  // 0.8 rad about the axis ahead: the left arm goes up, the right one down.
  EXPECT_LT((Forearm(0) - Eigen::Vector3d(0, std::cos(0.8), std::sin(0.8))).norm(), 0.02);
  EXPECT_LT((Forearm(1) - Eigen::Vector3d(0, -std::cos(0.8), -std::sin(0.8))).norm(), 0.02);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
}

TEST_F(PoseArmsTest, ABiasThatFootingdMakesOfASlowTurnIsPutBack) {
  TakeTPose();
  held_bias_radps = 0.1;
  Run(3, 0.1);
  EXPECT_LT((Forearm(0) - Eigen::Vector3d(0, std::cos(0.3), std::sin(0.3))).norm(), 0.02);
}

TEST_F(PoseArmsTest, WhatAHandDidBeforeTheTPoseIsNoPartOfIt) {
  arms.Follow(false, 0);
  roll_rad = 1.2;
  Run(4, 0);
  arms.Follow(false, 0.5);
  arms.Follow(false, 0);  // Broken off.
  roll_rad = 0;
  arms.Follow(false, 0.01);
  Run(5, 0);
  arms.Follow(true, 1);
  Run(0.1, 0);
  EXPECT_LT((Forearm(0) - Eigen::Vector3d::UnitY()).norm(), 0.01);
}

TEST_F(PoseArmsTest, AWiimoteThatIsLostTellsNothingUntilTheNextTPose) {
  TakeTPose();
  Run(0.1, 0);
  Run(0.15, 0, false);
  EXPECT_TRUE(inputs.sensors.arms[0].valid) << "a pause that it can be followed through";
  Run(0.5, 0, false);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kSilent);
  EXPECT_TRUE(inputs.sensors.arms[1].valid) << "the other one is told on";
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kNone);
  Run(1, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kAwaitsTPose);
  TakeTPose();
  Run(0.1, 0);
  EXPECT_TRUE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
}

TEST_F(PoseArmsTest, ANewTPoseMakesBothUnknownUntilItIsTaken) {
  TakeTPose();
  Run(0.1, 0);
  ASSERT_TRUE(inputs.sensors.arms[1].valid);
  arms.Follow(false, 0);
  Run(0.1, 0);
  EXPECT_FALSE(inputs.sensors.arms[0].valid || inputs.sensors.arms[1].valid);
}

TEST_F(PoseArmsTest, AWiimoteWithoutMotionPlusAndOneWithoutAModelAreNamed) {
  PoseArms without_model{std::nullopt};
  without_model.Bind(0, kLeft);
  without_model.Report(now_ns, inputs);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNoModel);
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kNone) << "none is there";
  v1::MotionSample sample;
  sample.set_device(kLeft);
  sample.set_sampled_ns(now_ns);
  arms.Take(sample, now_ns);
  arms.Report(now_ns, inputs);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNoGyroscope);
  EXPECT_EQ(inputs.hand_trouble[1], HandTrouble::kSilent);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
}

/// Wiimotes on both segments of the left arm, that point to the hand, and whose buttons face up.
struct StrappedArmTest : testing::Test {
  static constexpr std::uint32_t kUpper = 11, kForearm = 12;

  void Take(std::uint32_t device, double up_radps) {
    v1::MotionSample sample;
    sample.set_device(device);
    sample.set_sampled_ns(now_ns);
    sample.set_simulated(true);
    // S is x left, y front, z down: front to the left, up by `pitch_rad`.
    *sample.mutable_specific_force_mps2() =
        wire::ToProto(Eigen::Vector3d(0, kStandardGravityMps2 * std::sin(pitch_rad),
                                      -kStandardGravityMps2 * std::cos(pitch_rad)));
    // Ahead is to the right of its front: the negative x.
    *sample.mutable_angular_velocity_radps() = wire::ToProto(Eigen::Vector3d(-up_radps, 0, 0));
    arms.Take(sample, now_ns);
  }
  void Run(double seconds, double up_radps, bool forearm_too = true) {
    for (double t_s = 0; t_s < seconds - 1e-9; t_s += kPeriodS) {
      now_ns += SecondsToNanoseconds(kPeriodS);
      pitch_rad += up_radps * kPeriodS;
      Take(kUpper, up_radps);
      if (forearm_too) Take(kForearm, up_radps);
      arms.Report(now_ns, inputs);
    }
  }

  double pitch_rad = 0;
  std::int64_t now_ns = 50'000'000'000;
  PoseArms arms{std::nullopt};
  PoseInputs inputs;
};

TEST_F(StrappedArmTest, NeedsBothStrapsAndNoModel) {
  arms.Bind(0, kUpper, arms::Place::kUpperArm);
  Run(5, 0);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kOneStrap);
  arms.Bind(0, kForearm, arms::Place::kForearm);
  Run(5, 0);
  arms.Follow(true, 1);
  Run(0.7, 1);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kNone);
  ASSERT_TRUE(inputs.sensors.arms[0].valid);
  EXPECT_TRUE(inputs.simulated);
  const arms::ArmDirections& arm = inputs.sensors.arms[0].directions;
  const Eigen::Vector3d up(0, std::cos(0.7), std::sin(0.7));
  EXPECT_LT((arm.upper - up).norm(), 0.02) << arm.upper.transpose();
  EXPECT_LT((arm.forearm - up).norm(), 0.02);
  EXPECT_FALSE(inputs.sensors.arms[1].valid);
  Run(0.5, 0, false);
  EXPECT_FALSE(inputs.sensors.arms[0].valid);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kSilent);
  Run(0.5, 0);
  EXPECT_EQ(inputs.hand_trouble[0], HandTrouble::kAwaitsTPose);
}

}  // namespace
}  // namespace footing::pose_service
