#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "common/base/units.h"
#include "daemon/offline/learning/network.h"
#include "daemon/simulation/pose/arm_tracker.h"

namespace footing::arm_network {
namespace {

using Eigen::Vector3d;

const Vector3d kAxis = Vector3d(0.5, 0, -0.8).normalized();

Eigen::Matrix3d Forearm(const ArmPose& pose) {
  return pose.R_WU * Eigen::AngleAxisd(pose.elbow_rad, kAxis).toRotationMatrix();
}

TEST(ArmNetwork, PosesAndDirectionsAreTheSame) {
  ArmPose pose;
  pose.R_WU = Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  pose.elbow_rad = 0.9;
  const ArmPose back = ToPose(ToDirections(pose, kAxis));
  EXPECT_LT((back.R_WU - pose.R_WU).norm(), 1e-9);
  EXPECT_NEAR(back.elbow_rad, 0.9, 1e-9);
}

TEST(ArmNetwork, ThePredictionTurnsTheHandAsTheGyroscopeSays) {
  ArmPose pose;
  pose.elbow_rad = 1;
  const Vector3d turn_W(0.4, -1.1, 0.8);
  const ArmPose next = Predicted(pose, kAxis, turn_W, 1e-3);
  const Eigen::AngleAxisd moved(Forearm(next) * Forearm(pose).transpose());
  EXPECT_LT((moved.angle() * moved.axis() / 1e-3 - turn_W).norm(), 2e-3);
  // The least joint velocities: half of what is about the elbow's axis is the elbow's.
  EXPECT_NEAR((next.elbow_rad - 1) / 1e-3, kAxis.dot(turn_W) / 2, 1e-6);
}

/// An arm that swings and bends in step, with a stiff wrist; the attitude of the hand is known.
Sequence Swing(double hz, double seconds) {
  Sequence sequence;
  sequence.step_s = 1.0 / 60;
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
  for (int i = 0; i < std::lround(60 * seconds); ++i) {
    const double swing = 1 - std::cos(2 * kPi * hz * i * sequence.step_s);
    ArmPose pose;
    pose.R_WU = Eigen::AngleAxisd(-0.5 * swing, Vector3d::UnitX()).toRotationMatrix();
    pose.elbow_rad = 0.6 * swing;
    const Eigen::Matrix3d hand = Forearm(pose);
    FrameInput frame;
    frame.features.head<9>() = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(hand.data());
    const Eigen::AngleAxisd moved(hand * before.transpose());
    frame.angular_velocity_W_radps = moved.angle() * moved.axis() / sequence.step_s;
    frame.angular_velocity_H_radps = hand.transpose() * frame.angular_velocity_W_radps;
    frame.specific_force_H_mps2 = hand.transpose() * Vector3d(0, 0, kStandardGravityMps2);
    before = hand;
    sequence.inputs.push_back(frame);
    sequence.truth.push_back(pose);
    sequence.forearm.push_back(ToDirections(pose, kAxis).forearm);
  }
  return sequence;
}

double ClosedLoopElbowRms(const ArmNetwork& network, const Sequence& sequence) {
  double squares = 0;
  ArmPose pose;
  for (std::size_t i = 1; i < sequence.truth.size(); ++i) {
    pose = network.Next(pose, sequence.inputs[i], sequence.step_s);
    squares += std::pow(pose.elbow_rad - sequence.truth[i].elbow_rad, 2);
  }
  return std::sqrt(squares / static_cast<double>(sequence.truth.size()));
}

TEST(ArmNetwork, AResidualOnItsOwnEstimatesDividesASwingBetweenShoulderAndElbow) {
  const std::vector<Sequence> taught{Swing(0.3, 20), Swing(0.5, 20), Swing(0.9, 20)};
  const Trained trained = Train(Kind::kResidual, taught, {}, 1);
  EXPECT_LT((trained.network.elbow_axis_U - kAxis).norm(), 1e-6);
  const Sequence fresh = Swing(0.7, 40);
  ArmPose predicted;
  double squares = 0;
  for (std::size_t i = 1; i < fresh.truth.size(); ++i) {
    predicted = Predicted(predicted, kAxis, fresh.inputs[i].angular_velocity_W_radps, fresh.step_s);
    squares += std::pow(predicted.elbow_rad - fresh.truth[i].elbow_rad, 2);
  }
  const double alone = std::sqrt(squares / static_cast<double>(fresh.truth.size()));
  EXPECT_LT(ClosedLoopElbowRms(trained.network, fresh), 0.5 * alone);
  const Trained again = Train(Kind::kResidual, taught, {}, 1);
  EXPECT_EQ(again.network.network.weights().output_weights,
            trained.network.network.weights().output_weights);
}

TrainingOptions QuickOptions() {
  TrainingOptions options;
  options.rounds = 2;
  options.hidden_max = 2;
  return options;
}

/// The left arm as a tracker with the network has it, after a T-pose and a second of turning.
arms::ArmDirections Tracked(const ArmNetwork& network, int frames_a_reading) {
  arms::ArmTracker tracker(std::nullopt, network);
  tracker.UseNetwork(true);
  const double reading_s = 1.0 / 60;
  const auto add = [&](const Vector3d& turning) {
    for (std::size_t arm = 0; arm < arms::kArms; ++arm)
      tracker.Add(arm, {Vector3d(0, 0, kStandardGravityMps2), turning, false}, reading_s);
  };
  for (int i = 0; i < 120; ++i) add(Vector3d::Zero());
  tracker.Align();
  arms::ArmEstimate left;
  for (int i = 0; i < 60; ++i) {
    add({0, 0, 0.5});
    for (int k = 0; k < frames_a_reading; ++k)
      left = tracker.Advance(reading_s / frames_a_reading)[0];
  }
  EXPECT_TRUE(left.valid);
  tracker.UseNetwork(false);
  EXPECT_FALSE(tracker.Advance(reading_s)[0].valid) << "the tracker has no regression";
  return left.directions;
}

TEST(ArmNetwork, ATrackerRunsItAtItsOwnRate) {
  const ArmNetwork network = Train(Kind::kPaper, {Swing(0.5, 20)}, QuickOptions(), 1).network;
  const arms::ArmDirections at_60 = Tracked(network, 1), at_120 = Tracked(network, 2);
  EXPECT_LT(arms::ShoulderError(at_60, at_120), 0.05);
  EXPECT_TRUE(arms::Stacked(at_60).allFinite());
  EXPECT_GT(arms::ShoulderError(at_60, arms::ArmDirections{}), 1e-3) << "it moved";
}

TEST(ArmNetwork, AModelFileKeepsIt) {
  const Trained trained = Train(Kind::kPaper, {Swing(0.5, 10)}, QuickOptions(), 1);
  model::Model model{.kind = KindName(Kind::kPaper), .provenance = {}, .tensors = {}};
  AppendTensors(trained.network, model);
  const auto read = MakeArmNetwork(model, "made.fmodel");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->kind, Kind::kPaper);
  EXPECT_LT((read->elbow_axis_U - kAxis).norm(), 1e-6);
  const FrameInput frame = Swing(0.5, 1).inputs[30];
  EXPECT_LT((read->Next({}, frame, 1.0 / 60).R_WU - trained.network.Next({}, frame, 1.0 / 60).R_WU)
                .norm(),
            1e-5);
  model.kind = KindName(Kind::kResidual);
  const auto other = MakeArmNetwork(model, "made.fmodel");
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("inputs"), std::string::npos);
  model.kind = "arm";
  EXPECT_FALSE(MakeArmNetwork(model, "made.fmodel").ok());
}

}  // namespace
}  // namespace footing::arm_network
