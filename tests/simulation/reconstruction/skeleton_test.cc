#include "daemon/simulation/reconstruction/skeleton.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/body/points.h"
#include "common/body/skeleton_points.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

using stream::BodyJoint;

constexpr double kJointSdM = 0.04;

/// All joints of a pose where they are, moved by `offset_m`.
JointInputs JointsAt(const body::Body& person, const body::Kinematics& at,
                     const Eigen::Vector3d& offset_m = Eigen::Vector3d::Zero()) {
  const auto points = body::SkeletonPoints(person);
  JointInputs joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    joints[i].valid = true;
    joints[i].p_W_m = offset_m + body::Place(points[i], at);
    joints[i].sd_m.setConstant(kJointSdM);
  }
  return joints;
}

struct SkeletonTest : testing::Test {
  World world;
  SubjectModel model = BestSubjectModel(world.person, world.models, world.AtRate()).value();

  const body::Kinematics& Truth(std::size_t i) {
    body::ComputeKinematics(world.person.skeleton, world.motion.q.col(static_cast<Eigen::Index>(i)),
                            world.at);
    return world.at;
  }
  /// The inputs of a frame with all joints, moved by `offset_m`.
  Inputs WithJoints(std::size_t i, const Eigen::Vector3d& offset_m = Eigen::Vector3d::Zero()) {
    Inputs inputs = world.inputs[i];
    inputs.joints = JointsAt(world.person, Truth(i), offset_m);
    return inputs;
  }
};

JointInput& Of(JointInputs& joints, BodyJoint joint) { return joints[body::IndexOf(joint)]; }

TEST_F(SkeletonTest, OnlyJointsThatAreSeenAreTerms) {
  JointInputs joints = JointsAt(world.person, model.t_pose_at);
  Of(joints, BodyJoint::kLeftKnee).valid = false;
  pose::PoseTargets targets;
  AddJointTargets(model.joints, joints, targets);
  EXPECT_EQ(targets.count, 12);
  AddJointTargets(model.joints, {}, targets);
  EXPECT_EQ(targets.count, 12);
}

TEST_F(SkeletonTest, AJointsCovarianceWhitensIt) {
  JointInputs joints;
  JointInput& head = Of(joints, BodyJoint::kHead);
  head.valid = true;
  head.sd_m << 0.03, 0.05, 0.02;
  head.covariance_m2 << 0.0006, 0, -0.0004;
  pose::PoseTargets targets;
  AddJointTargets(model.joints, joints, targets);
  Eigen::Matrix3d covariance = head.sd_m.cwiseAbs2().asDiagonal();
  covariance(0, 1) = covariance(1, 0) = 0.0006;
  covariance(1, 2) = covariance(2, 1) = -0.0004;
  const Eigen::Vector3d off_m(0.04, -0.03, 0.05);
  // Mahalanobis' distance, but for the thousandth by which correlations count less.
  const double expected = off_m.dot(covariance.inverse() * off_m);
  EXPECT_NEAR(Whitened(targets.points[0], off_m).squaredNorm(), expected, 0.01 * expected);
}

TEST_F(SkeletonTest, AJointThatIsFarOffCountsLessAndAnImplausibleOneNot) {
  JointInputs joints = JointsAt(world.person, model.t_pose_at);
  Of(joints, BodyJoint::kLeftElbow).p_W_m.x() += 5 * kJointSdM;
  Of(joints, BodyJoint::kHead).p_W_m.z() += 1;
  Of(joints, BodyJoint::kNeck).p_W_m.y() = std::numeric_limits<double>::quiet_NaN();
  GateJoints(model.joints, model.t_pose_at, joints);
  EXPECT_NEAR(Of(joints, BodyJoint::kLeftElbow).sd_m.x(), 5 / 3.5 * kJointSdM, 1e-9);
  EXPECT_FALSE(Of(joints, BodyJoint::kHead).valid);
  EXPECT_FALSE(Of(joints, BodyJoint::kNeck).valid);
  EXPECT_TRUE(Of(joints, BodyJoint::kLeftKnee).valid);
  EXPECT_EQ(Of(joints, BodyJoint::kLeftKnee).sd_m.x(), kJointSdM);
}

TEST_F(SkeletonTest, WhereAllJointsAreFarOffThePoseIsWrong) {
  JointInputs joints = JointsAt(world.person, model.t_pose_at, {0.6, 0, 0});
  GateJoints(model.joints, model.t_pose_at, joints);
  for (const JointInput& joint : joints) {
    EXPECT_TRUE(joint.valid);
    EXPECT_GT(joint.sd_m.x(), 4 * kJointSdM);
  }
}

TEST_F(SkeletonTest, WhatIsAbsentCostsNothing) {
  Reconstruction without = world.Made(world.AtRate()), absent = without;
  for (std::size_t i = 0; i < 500; ++i) {
    Inputs inputs = WithJoints(i);
    for (JointInput& joint : inputs.joints) joint.valid = false;
    absent.Advance(inputs);
    without.Advance(world.inputs[i]);
    ASSERT_EQ(absent.output().q, without.output().q) << i;
  }
}

TEST_F(SkeletonTest, BoardsCarryTheLegsThatTheCameraLoses) {
  Reconstruction fused = world.Made(world.AtRate()), hands_only = fused;
  const auto knee = static_cast<std::size_t>(world.person.landmarks[body::Landmark::kLeftKnee]);
  double fused_m = 0, hands_only_m = 0;
  for (std::size_t i = 0; i < world.inputs.size(); ++i) {
    Inputs inputs = WithJoints(i);
    for (std::size_t k = body::IndexOf(BodyJoint::kLeftHip); k < inputs.joints.size(); ++k) {
      inputs.joints[k].valid = false;
    }
    fused.Advance(inputs);
    hands_only.Advance(world.inputs[i]);
    ASSERT_TRUE(Finite(fused.output())) << i;
    if (i < 400) continue;
    const Eigen::Vector3d& truth_m = Truth(i).p_WJ[knee];
    const double share = 1.0 / static_cast<double>(world.inputs.size() - 400);
    fused_m += share * (fused.output().p_WJ_m[knee] - truth_m).norm();
    hands_only_m += share * (hands_only.output().p_WJ_m[knee] - truth_m).norm();
  }
  EXPECT_LT(fused_m, 0.08);
  EXPECT_LT(fused_m, hands_only_m + 0.01);
  EXPECT_TRUE(fused.output().valid);
}

TEST_F(SkeletonTest, AJointThatJumpsMovesThePoseLittleAndNothingIsEverNaN) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Reconstruction fused = world.Made(world.AtRate()), jumped = fused;
  for (std::size_t i = 0; i < 500; ++i) {
    Inputs inputs = WithJoints(i);
    fused.Advance(inputs);
    if (i >= 400) {
      Of(inputs.joints, BodyJoint::kRightKnee).p_W_m.x() += 1;
      Of(inputs.joints, BodyJoint::kHead).p_W_m.z() = kNaN;
      Of(inputs.joints, BodyJoint::kNeck).covariance_m2.setConstant(kNaN);
      Of(inputs.joints, BodyJoint::kTorso).covariance_m2.setConstant(1);  // Of no errors.
      Of(inputs.joints, BodyJoint::kLeftFoot).sd_m.setZero();
    }
    jumped.Advance(inputs);
    ASSERT_TRUE(Finite(jumped.output())) << i;
  }
  EXPECT_LT(world.ErrorM(jumped.output(), 499, 0), world.ErrorM(fused.output(), 499, 0) + 0.02);
}

TEST_F(SkeletonTest, WhatAllJointsAreOffByIsLearnedInASecond) {
  const Eigen::Vector3d offset_m(0.06, -0.05, 0.04);
  Inputs inputs;
  inputs.joints = JointsAt(world.person, model.t_pose_at, offset_m);
  inputs.hands[0].valid = inputs.hands[0].of_skeleton = true;
  SkeletonOffset offset;
  constexpr double kStepS = 0.01;
  for (int i = 0; i < 100; ++i) {
    offset.Learn(model.joints, offset.Without(inputs).joints, model.t_pose_at, kStepS);
  }
  // (1 - step)^100 = 1 / e of it is left.
  EXPECT_LT((offset.offset_m() - (1 - std::exp(-1)) * offset_m).norm(), 0.001);
  EXPECT_EQ(offset.Without(inputs).hands[0].p_W_m, -offset.offset_m());
  inputs.hands[0].of_skeleton = false;
  EXPECT_EQ(offset.Without(inputs).hands[0].p_W_m, Eigen::Vector3d::Zero()) << "another tracker";
}

TEST_F(SkeletonTest, WhatAHeadAloneIsOffByIsThePosesError) {
  Inputs inputs;
  JointInputs all = JointsAt(world.person, model.t_pose_at, {0.06, -0.05, 0.04});
  Of(inputs.joints, BodyJoint::kHead) = Of(all, BodyJoint::kHead);
  SkeletonOffset offset;
  for (int i = 0; i < 100; ++i) {
    offset.Learn(model.joints, offset.Without(inputs).joints, model.t_pose_at, 0.01);
  }
  EXPECT_EQ(offset.offset_m(), Eigen::Vector3d::Zero());
}

TEST_F(SkeletonTest, AHeadAloneDrawsThePoseToItForGood) {
  const Reconstruction free = world.FreelyMade();
  Reconstruction with = free, without = free;
  const std::size_t head = body::IndexOf(BodyJoint::kHead);
  constexpr double kAsideM = 0.06;
  for (std::size_t i = 0; i < 560; ++i) {
    Inputs inputs = world.inputs[i];
    // Its place on the head is found first.
    inputs.joints[head] = WithJoints(i, {0, i < 400 ? 0 : kAsideM, 0}).joints[head];
    inputs.joints[head].sd_m.setConstant(0.01);
    with.Advance(inputs);
    without.Advance(world.inputs[i]);
    ASSERT_TRUE(Finite(with.output())) << i;
  }
  const auto joint = static_cast<std::size_t>(model.joints[head].joint);
  EXPECT_GT(with.output().p_WJ_m[joint].y() - without.output().p_WJ_m[joint].y(), 0.25 * kAsideM);
}

TEST_F(SkeletonTest, ACameraThatIsOffDoesNotMoveThePoseForLong) {
  Reconstruction right = world.Made(world.AtRate()), off = right;
  for (std::size_t i = 0; i < world.inputs.size(); ++i) {
    right.Advance(WithJoints(i));
    off.Advance(WithJoints(i, {0.06, -0.05, 0.04}));
  }
  const std::size_t last = world.inputs.size() - 1;
  EXPECT_LT(world.ErrorM(off.output(), last, 0), world.ErrorM(right.output(), last, 0) + 0.015);
}

TEST_F(SkeletonTest, TheSameInputsGiveTheSameBits) {
  Reconstruction one = world.Made(world.AtRate()), other = world.Made(world.AtRate());
  for (std::size_t i = 0; i < 450; ++i) {
    Inputs inputs = WithJoints(i, {0.02, 0.01, 0});
    if (i % 40 > 30) inputs.joints = {};  // It loses the person now and then.
    ASSERT_EQ(one.Advance(inputs).q, other.Advance(inputs).q) << i;
  }
}

}  // namespace
}  // namespace footing::reconstruction
