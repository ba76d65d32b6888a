#include "daemon/simulation/pose/arm_tracker.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/pose/arm_model.h"
#include "tests/simulation/allocations.h"

namespace footing::arms {
namespace {

using body::Landmark;

struct Person {
  body::Body body = body::MakeBody(body::StandardPerson(1.75), {}).value();
  Eigen::VectorXd q = body::TPose(body.skeleton, body.landmarks);
  body::Kinematics at{body.skeleton};

  Person() { Place(); }
  void Place() { body::ComputeKinematics(body.skeleton, q, at); }
  void Turn(Landmark landmark, body::Axis axis, double angle_rad) {
    const int index = body.landmarks[landmark];
    const body::Joint& joint = body.skeleton.joint(index);
    body::SetJointRotation(joint,
                           at.R_WJ[static_cast<std::size_t>(joint.parent)].transpose() *
                               body::AxisRotation(axis, angle_rad) *
                               at.R_WJ[static_cast<std::size_t>(index)],
                           q);
    Place();
  }
};

TEST(ArmGeometry, TheArmsOfATPoseAreLevel) {
  const Person person;
  for (const int side : {0, 1}) {
    const ArmGeometry geometry(person.body, side);
    const ArmDirections arm = geometry.Directions(person.at);
    const Eigen::Vector3d outwards(0, side == 0 ? 1 : -1, 0);
    EXPECT_LT((arm.upper - outwards).norm(), 0.02);
    EXPECT_LT((arm.forearm - outwards).norm(), 0.02);
    EXPECT_LT((arm.hinge - Eigen::Vector3d::UnitZ()).norm(), 1e-9);
    const auto fist = static_cast<std::size_t>(geometry.fist.joint);
    const Eigen::Vector3d hand =
        body::Place(geometry.fist, person.at.R_WJ[fist], person.at.p_WJ[fist]) -
        person.at.p_WJ[static_cast<std::size_t>(geometry.shoulder)];
    EXPECT_LT((geometry.Hand(arm) - hand).norm(), 1e-9);
  }
}

TEST(ArmGeometry, ErrorsAreTheAnglesOfShoulderAndElbow) {
  Person person;
  const ArmGeometry geometry(person.body, 0);
  const ArmDirections rest = geometry.Directions(person.at);
  EXPECT_NEAR(ShoulderError(rest, rest), 0, 1e-6);
  person.Turn(Landmark::kLeftShoulder, body::Axis::kX, -0.7);
  const ArmDirections lowered = geometry.Directions(person.at);
  EXPECT_NEAR(ShoulderError(rest, lowered), 0.7, 0.01);
  EXPECT_NEAR(ElbowError(rest, lowered), 0, 1e-6);
  const double before = std::acos(lowered.upper.dot(lowered.forearm));
  person.Turn(Landmark::kLeftElbow, body::Axis::kZ, -0.5);
  const ArmDirections bent = geometry.Directions(person.at);
  EXPECT_NEAR(ShoulderError(lowered, bent), 0, 1e-6);
  EXPECT_NEAR(ElbowError(lowered, bent), std::abs(std::acos(bent.upper.dot(bent.forearm)) - before),
              1e-9);
  EXPECT_GT(ElbowError(lowered, bent), 0.3);
}

TEST(ArmFeatures, ARightArmIsTheMirrorImageOfALeftOne) {
  noise::Random random(3);
  ArmFeatures features;
  const Eigen::Vector3d mirror(1, -1, 1);
  for (int i = 0; i < 50; ++i) {
    std::array<HandState, kArms> hands;
    Eigen::Vector3d axis;
    for (double& value : axis) value = random.Normal();
    for (double& value : hands[0].acceleration_W_mps2) value = 5 * random.Normal();
    hands[0].angular_velocity_W_radps = axis;
    hands[0].turn_W = Eigen::AngleAxisd(0.1 * i, axis.normalized()).toRotationMatrix();
    hands[1].turn_W = mirror.asDiagonal() * hands[0].turn_W * mirror.asDiagonal();
    hands[1].acceleration_W_mps2 = mirror.asDiagonal() * hands[0].acceleration_W_mps2;
    // The mirror image of a turn to the left is one to the right.
    hands[1].angular_velocity_W_radps = {-axis.x(), axis.y(), -axis.z()};
    features.Advance(hands, 1.0 / 60);
  }
  ArmFeatures::Values left, right;
  features.Compute(0, left);
  features.Compute(1, right);
  EXPECT_LT((left - right).norm(), 1e-9);
  EXPECT_GT(left.norm(), 1);
}

/// Forearm and upper arm go where the hand's axis goes that was along the arm in the T-pose.
ArmModel StiffArm() {
  ArmModel model;
  model.mean.setZero();
  model.scale.setOnes();
  model.weights.setZero(kDirections, ArmFeatures::kCount);
  model.offset.setZero();
  for (int k = 0; k < 3; ++k) {
    model.weights(k, 3 + k) = model.weights(6 + k, 3 + k) = 1;  // Second column of the turn.
    model.weights(3 + k, 6 + k) = 1;
  }
  model.covariance = 0.04 * Eigen::Matrix<double, kDirections, kDirections>::Identity();
  return model;
}

HandReading Reading(const Eigen::Matrix3d& R_WS, const Eigen::Vector3d& w_W) {
  return {R_WS.transpose() * Eigen::Vector3d(0, 0, kStandardGravityMps2), R_WS.transpose() * w_W,
          false};
}

TEST(ArmTracker, ToldArmsFollowTheHands) {
  ArmTracker tracker(StiffArm());
  constexpr double kStepS = 0.01;
  const Eigen::Matrix3d level = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 500; ++i) {
    for (const std::size_t arm : {0u, 1u}) tracker.Add(arm, Reading(level, {0, 0, 0}), kStepS);
    EXPECT_FALSE(tracker.Advance(kStepS)[0].valid);
  }
  tracker.Align();
  // The left arm goes down about x, the right one up.
  const Eigen::Vector3d w_W(-1, 0, 0);
  for (int i = 1; i <= 80; ++i) {
    const Eigen::Matrix3d R_WS =
        Eigen::AngleAxisd(-kStepS * i, Eigen::Vector3d::UnitX()).toRotationMatrix();
    for (const std::size_t arm : {0u, 1u}) tracker.Add(arm, Reading(R_WS, w_W), kStepS);
    tracker.Advance(kStepS);
  }
  const auto& told = tracker.Advance(kStepS);
  ASSERT_TRUE(told[0].valid && told[1].valid);
  const Eigen::Vector3d down(0, std::cos(0.8), -std::sin(0.8)),
      up(0, -std::cos(0.8), std::sin(0.8));
  EXPECT_LT((told[0].directions.forearm - down).norm(), 0.01);
  EXPECT_LT((told[1].directions.forearm - up).norm(), 0.01);
  // The model's, and of the inclination's 0.6 degrees.
  EXPECT_NEAR(told[0].forearm_sd.x(), std::hypot(0.2, DegreesToRadians(0.6)), 1e-3);
}

/// A device of the left arm that rests in the T-pose and then turns up about the axis ahead.
struct LeftArm {
  static constexpr double kStepS = 0.01;
  ArmTracker tracker;
  std::vector<Place> places;
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();  ///< Attitude of the one in the fist.
  std::array<ArmEstimate, kArms> estimates;

  LeftArm(const std::optional<ArmModel>& model, std::vector<Place> devices)
      : tracker(model), places(std::move(devices)) {
    Run(5, 0);
    tracker.Align();
  }
  void Run(double seconds, double up_radps, double forearm_radps = 0) {
    for (int i = 0; i < std::lround(seconds / kStepS); ++i) {
      R_WS = Eigen::AngleAxisd(kStepS * up_radps, Eigen::Vector3d::UnitX()) * R_WS;
      R_WB = Eigen::AngleAxisd(kStepS * forearm_radps, R_WS.col(2)) * R_WB;
      R_WB = Eigen::AngleAxisd(kStepS * up_radps, Eigen::Vector3d::UnitX()) * R_WB;
      const Eigen::Vector3d up_W(up_radps, 0, 0);
      for (const Place place : places) {
        // Along the arm, and rolled about it.
        const Eigen::Matrix3d mounted =
            place == Place::kFist
                ? Eigen::Matrix3d::Identity()
                : (Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(2, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
        const bool bends = place == Place::kForearm;
        const Eigen::Vector3d w_W =
            up_W + (bends ? forearm_radps : 0) * Eigen::Vector3d(R_WS.col(2));
        tracker.Add(0, Reading((bends ? R_WB : R_WS) * mounted, w_W), kStepS, place);
      }
      estimates = tracker.Advance(kStepS);
    }
  }

  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();  ///< Forearm's turn since the T-pose.
};

TEST(ArmTracker, ItsDeviationsGrowAsTheHeadingDrifts) {
  LeftArm arm(StiffArm(), {Place::kFist});
  arm.Run(1, 0);
  const ArmEstimate first = arm.estimates[0];
  const double heading_sd = arm.tracker.hand(0).heading_sd_rad;
  for (int i = 0; i < 120; ++i) arm.Run(1, i % 2 == 0 ? 0.5 : -0.5);
  const ArmEstimate later = arm.estimates[0];
  const double grown_rad = arm.tracker.hand(0).heading_sd_rad;
  EXPECT_GT(grown_rad, 2 * heading_sd);
  // The forearm points to the left: a wrong heading turns it ahead or back, the hinge, which points
  // up, nowhere.
  EXPECT_NEAR(later.forearm_sd.x(),
              std::sqrt(std::pow(first.forearm_sd.x(), 2) + std::pow(grown_rad, 2) -
                        std::pow(heading_sd, 2)),
              1e-3);
  EXPECT_NEAR(later.hinge_sd.x(), first.hinge_sd.x(), 1e-3);
}

TEST(ArmTracker, StrapsOnBothSegmentsMeasureAnArmWithoutAModel) {
  LeftArm arm(std::nullopt, {Place::kUpperArm, Place::kForearm});
  arm.Run(0.6, 1);
  arm.Run(0.5, 0, -1);  // The forearm bends forwards.
  const ArmEstimate& left = arm.estimates[0];
  ASSERT_TRUE(left.valid);
  EXPECT_FALSE(arm.estimates[1].valid) << "nothing is on the right arm";
  EXPECT_LT((left.directions.upper - Eigen::Vector3d(0, std::cos(0.6), std::sin(0.6))).norm(),
            0.01);
  EXPECT_LT((left.directions.hinge - Eigen::Vector3d(0, -std::sin(0.6), std::cos(0.6))).norm(),
            0.01);
  const Eigen::Vector3d forearm(std::sin(0.5), std::cos(0.5) * std::cos(0.6),
                                std::cos(0.5) * std::sin(0.6));
  EXPECT_LT((left.directions.forearm - forearm).norm(), 0.01);
  EXPECT_LT(left.forearm_sd.maxCoeff(), 0.15);
  EXPECT_GT(left.forearm_sd.minCoeff(), 0.015);
  arm.tracker.Lose(0, Place::kForearm);
  EXPECT_FALSE(arm.tracker.Advance(0.01)[0].valid) << "one strap is half an arm";
}

TEST(ArmTracker, AStrapBesideTheFistTakesTheUpperArmOver) {
  LeftArm alone(StiffArm(), {Place::kFist}), both(StiffArm(), {Place::kFist, Place::kUpperArm});
  for (LeftArm* arm : {&alone, &both}) arm->Run(0.6, 1);
  EXPECT_LT(both.estimates[0].upper_sd.maxCoeff(), 0.5 * alone.estimates[0].upper_sd.maxCoeff());
  EXPECT_NEAR(both.estimates[0].forearm_sd.x(), alone.estimates[0].forearm_sd.x(), 0.01)
      << "the model knows of no connection";
}

TEST(ArmTracker, AdvancesWithoutAllocating) {
  ArmTracker tracker(StiffArm());
  const HandReading reading = Reading(Eigen::Matrix3d::Identity(), {0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    for (const std::size_t arm : {0u, 1u}) tracker.Add(arm, reading, 0.01);
  }
  tracker.Align();
  const long before = test::Allocations();
  for (int i = 0; i < 100; ++i) {
    for (const std::size_t arm : {0u, 1u}) tracker.Add(arm, reading, 0.01);
    tracker.Advance(0.01);
  }
  EXPECT_EQ(test::Allocations(), before);
}

TEST(ArmModel, RefusesATensorOfAnotherShapeByName) {
  model::Model model{.kind = "arm", .provenance = {}, .tensors = {}};
  const auto add = [&](const char* name, std::vector<std::uint32_t> shape, float value) {
    std::size_t count = 1;
    for (const std::uint32_t size : shape) count *= size;
    model.tensors.push_back({name, shape, std::vector<float>(count, value)});
  };
  constexpr auto kFeatures = static_cast<std::uint32_t>(ArmFeatures::kCount);
  add("feature_mean", {kFeatures}, 0);
  add("feature_scale", {kFeatures}, 1);
  add("regression_weights", {9, kFeatures}, 0.5f);
  add("regression_offset", {9}, 0);
  add("error_covariance", {9, 9}, 0.25f);
  const auto made = MakeArmModel(model, "made.fmodel");
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(made->weights(8, ArmFeatures::kCount - 1), 0.5);
  model.tensors[4].values[0] = -1;
  EXPECT_FALSE(MakeArmModel(model, "made.fmodel").ok());
  model.tensors[4].values[0] = 1;
  model.tensors[2].shape = {kFeatures, 9};
  const auto turned = MakeArmModel(model, "made.fmodel");
  ASSERT_FALSE(turned.ok());
  EXPECT_NE(turned.error().message.find("made.fmodel"), std::string::npos);
  EXPECT_NE(turned.error().message.find("regression_weights"), std::string::npos);
  model.kind = "com";
  EXPECT_FALSE(MakeArmModel(model, "made.fmodel").ok());
}

}  // namespace
}  // namespace footing::arms
