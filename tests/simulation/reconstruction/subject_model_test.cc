#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "common/body/kinematics.h"
#include "common/body/skeleton_points.h"
#include "common/virtual/devices/noise.h"
#include "daemon/simulation/reconstruction/subject_model.h"
#include "tests/simulation/reconstruction/made_world.h"

namespace footing::reconstruction {
namespace {

constexpr double kHandTrackStepS = 1.0 / 30;
const Eigen::Vector3d kSdM = Eigen::Vector3d::Constant(0.02);

TEST(HandTrack, AJointIsFollowedAsSlowerThanAHand) {
  HandTrack hand;
  HandTrack joint = JointTracks()[body::IndexOf(stream::BodyJoint::kLeftElbow)];
  for (HandTrack* track : {&hand, &joint}) {
    for (int i = 0; i < 60; ++i) {
      track->Add(i / 30.0, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::Constant(0.02));
    }
  }
  const double late_s = 59 / 30.0 + 0.1;
  const double hand_sd_m = hand.At(late_s).sd_m.x(), joint_sd_m = joint.At(late_s).sd_m.x();
  EXPECT_GT(joint_sd_m, 0.02);
  EXPECT_LT(joint_sd_m, 0.75 * hand_sd_m);
}

TEST(HandTrack, IsInvalidBeforeTheFirstPlaceAndThenThere) {
  HandTrack track;
  EXPECT_FALSE(track.At(1).valid);
  track.Add(1, {0.1, -0.8, 1.4}, kSdM);
  EXPECT_TRUE(track.At(1).valid);
  EXPECT_EQ(track.At(1).p_W_m, Eigen::Vector3d(0.1, -0.8, 1.4));
  EXPECT_LT((track.At(1).sd_m - kSdM).norm(), 1e-12);
  EXPECT_EQ(track.At(0.5).p_W_m, track.At(1).p_W_m) << "never before what was told";
}

TEST(HandTrack, CarriesASteadyHandOnOverTheDelay) {
  HandTrack track;
  const Eigen::Vector3d speed_mps(1, -0.5, 0.2);
  double t_s = 0;
  for (; t_s < 1; t_s += kHandTrackStepS) track.Add(t_s, t_s * speed_mps, kSdM);
  t_s -= kHandTrackStepS;
  const HandInput now = track.At(t_s + 0.08);
  // The hand travels 9 cm; it is thought to slow down.
  EXPECT_LT((now.p_W_m - (t_s + 0.08) * speed_mps).norm(), 0.03);
  EXPECT_GT(now.sd_m.minCoeff(), kSdM.x());
  EXPECT_GT(track.At(t_s + 0.2).sd_m.x(), now.sd_m.x());
  EXPECT_EQ(track.At(t_s + 5).p_W_m, track.At(t_s + HandTrack::kFurthestS).p_W_m);
}

TEST(HandTrack, OfADelaysErrorInASwingLittleMoreThanHalfIsLeft) {
  // A swing of 0.3 m at 0.8 Hz, told with 1.5 cm of noise and 83 ms late.
  noise::Random random(3);
  HandTrack track;
  constexpr double kLateS = 0.083, kOmega = 2 * 3.14159265358979 * 0.8;
  double carried = 0, left = 0;
  for (int i = 0; i < 3000; ++i) {
    const double t_s = i * kHandTrackStepS;
    const Eigen::Vector3d told(0.3 * std::sin(kOmega * t_s) + 0.015 * random.Normal(), 0, 1);
    track.Add(t_s, told, Eigen::Vector3d::Constant(0.043));
    const double truth_m = 0.3 * std::sin(kOmega * (t_s + kLateS));
    carried += std::pow(track.At(t_s + kLateS).p_W_m.x() - truth_m, 2);
    left += std::pow(told.x() - truth_m, 2);
  }
  EXPECT_LT(std::sqrt(carried), 0.65 * std::sqrt(left));
}

TEST(HandTrack, BeginsAnewAfterAPauseAndIgnoresWhatComesOutOfOrder) {
  HandTrack track;
  for (int i = 0; i < 10; ++i) track.Add(i * kHandTrackStepS, {0.1 * i, 0, 0}, kSdM);
  track.Add(0.2, {9, 9, 9}, kSdM);
  EXPECT_LT(track.At(0.3).p_W_m.norm(), 2);
  track.Add(5, {1, 2, 3}, kSdM);
  EXPECT_EQ(track.At(5.05).p_W_m, Eigen::Vector3d(1, 2, 3)) << "its speed is not known any more";
  track.Add(1, {3, 2, 1}, kSdM);  // Another clock.
  EXPECT_EQ(track.At(1).p_W_m, Eigen::Vector3d(3, 2, 1));
}

constexpr double kCapM = 0.15;

struct HeadSeatTest : testing::Test {
  World world;
  SubjectModel model = BestSubjectModel(world.person, world.models, world.AtRate()).value();

  /// A sphere `above_m` the middle of the head, fixed to it, in a pose.
  JointInputs Sphere(const body::Kinematics& at, double above_m) const {
    body::Point point = model.joints[kHeadJoint];
    point.p_J_m += model.t_pose_at.R_WJ[static_cast<std::size_t>(point.joint)].transpose() *
                   Eigen::Vector3d(0, 0, above_m);
    JointInputs joints;
    joints[kHeadJoint].valid = true;
    joints[kHeadJoint].p_W_m = body::Place(point, at);
    joints[kHeadJoint].sd_m.setConstant(0.01);
    return joints;
  }
  /// The mean error of the neck over the motion, with a sphere `above_m` the head.
  double NeckErrorM(double above_m, bool seen_in_t_pose) {
    Reconstruction run = world.Made(world.AtRate());
    const auto neck = static_cast<std::size_t>(world.person.landmarks[body::Landmark::kNeck]);
    double sum_m = 0, frames = 0;
    for (std::size_t i = 0; i < world.inputs.size(); ++i) {
      body::ComputeKinematics(world.person.skeleton,
                              world.motion.q.col(static_cast<Eigen::Index>(i)), world.at);
      Inputs inputs = world.inputs[i];
      if (seen_in_t_pose || run.output().calibrated) inputs.joints = Sphere(world.at, above_m);
      run.Advance(inputs);
      EXPECT_TRUE(Finite(run.output())) << i;
      if (i < 400) continue;
      sum_m += (run.output().p_WJ_m[neck] - world.at.p_WJ[neck]).norm();
      ++frames;
    }
    return sum_m / frames;
  }
};

TEST_F(HeadSeatTest, ACapIsWhereThePoseHasItAfterTheTPose) {
  const body::Point& middle = model.joints[kHeadJoint];
  HeadSeat seat;
  seat.Start(middle);
  for (int i = 0; seat.Seeks(); ++i) {
    ASSERT_LT(i, 51);
    EXPECT_FALSE(seat.found());
    JointInputs joints = Sphere(model.t_pose_at, kCapM);
    joints[kHeadJoint].valid = i >= 4;  // A tracker is late.
    seat.See(joints, model.t_pose_at, 0.01);
  }
  ASSERT_TRUE(seat.found());
  const Eigen::Vector3d off_m =
      body::Place(seat.point(), model.t_pose_at) - body::Place(middle, model.t_pose_at);
  EXPECT_LT((off_m - Eigen::Vector3d(0, 0, kCapM)).norm(), 1e-9);
  seat.See(Sphere(model.t_pose_at, 1), model.t_pose_at, 0.01);
  EXPECT_LT(
      (body::Place(seat.point(), model.t_pose_at) - body::Place(middle, model.t_pose_at)).norm(),
      kCapM + 1e-9)
      << "it is found once";
  seat.Start(middle);
  EXPECT_TRUE(seat.Seeks());
  EXPECT_EQ(seat.point().p_J_m, middle.p_J_m);
}

TEST_F(HeadSeatTest, ASkeletonsHeadAndOneSeldomSeenFarOffOrRoughHaveNoSeat) {
  const body::Point& middle = model.joints[kHeadJoint];
  HeadSeat skeletons, seldom, far, rough;
  for (HeadSeat* seat : {&skeletons, &seldom, &far, &rough}) seat->Start(middle);
  for (int i = 0; far.Seeks(); ++i) {
    JointInputs joints = Sphere(model.t_pose_at, kCapM);
    joints[kHeadJoint].valid = i % 3 == 0;
    seldom.See(joints, model.t_pose_at, 0.01);
    for (JointInput& joint : joints) joint.valid = true;
    skeletons.See(joints, model.t_pose_at, 0.01);
    JointInputs kinect = Sphere(model.t_pose_at, 0.04);
    kinect[kHeadJoint].sd_m.setConstant(0.043);
    rough.See(kinect, model.t_pose_at, 0.01);
    far.See(Sphere(model.t_pose_at, 0.4), model.t_pose_at, 0.01);
  }
  for (HeadSeat* seat : {&skeletons, &seldom, &far, &rough}) {
    EXPECT_FALSE(seat->Seeks() || seat->found());
    EXPECT_EQ(seat->point().p_J_m, middle.p_J_m);
  }
}

TEST_F(HeadSeatTest, ACapShowsTheTrunkAsWellAsAPointWithinTheHead) {
  const double none_m = NeckErrorM(10, false);  // Not plausible: as if there were none.
  const double cap_m = NeckErrorM(kCapM, true), within_m = NeckErrorM(0, true);
  EXPECT_LT(cap_m, 0.9 * none_m);
  EXPECT_NEAR(cap_m, within_m, 0.003);
}

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
      Of(inputs.joints, BodyJoint::kTorso).covariance_m2.setConstant(1);  // Not a valid covariance.
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
