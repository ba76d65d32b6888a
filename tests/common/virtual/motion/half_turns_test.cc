#include "common/virtual/motion/half_turns.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/base/units.h"
#include "common/virtual/options/load.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

using body::Landmark;

constexpr double kRateHz = 120;

std::size_t Index(int value) { return static_cast<std::size_t>(value); }

/// A standard person who squats as deep as knees bend, and comes up again.
Motion Squat() {
  Motion motion{body::StandardPerson(1.75), kRateHz, 0, {}};
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const auto dof = [&](Landmark left, int side) {
    return motion.skeleton.joint(landmarks[body::OfSide(left, side)]).first_dof;
  };
  motion.q.resize(motion.skeleton.dof, 240);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double down = 0.5 - 0.5 * std::cos(2 * kPi * static_cast<double>(i) / 240);
    Eigen::VectorXd q = body::TPose(motion.skeleton, landmarks);
    for (int side = 0; side < 2; ++side) {
      q.segment<3>(dof(Landmark::kLeftHip, side)) +=
          down * Eigen::Vector3d(0.4, side == 0 ? 0.5 : -0.5, 1.2);
      q(dof(Landmark::kLeftKnee, side)) += 2.7 * down;
      q(dof(Landmark::kLeftAnkle, side)) += 0.4 * down;
    }
    motion.q.col(i) = q;
  }
  return motion;
}

/// The other solution of the leg in these frames, as a fit to markers can find it.
void TurnByHalf(int side, Eigen::Index from, Eigen::Index to, Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const auto joint = [&](Landmark left) {
    return motion.skeleton.joint(landmarks[body::OfSide(left, side)]);
  };
  const body::Joint hip = joint(Landmark::kLeftHip), knee = joint(Landmark::kLeftKnee),
                    ankle = joint(Landmark::kLeftAnkle);
  const Eigen::Matrix3d half =
      Eigen::AngleAxisd(kPi, knee.offset_m.normalized()).toRotationMatrix();
  for (Eigen::Index i = from; i < to; ++i) {
    Eigen::VectorXd q = motion.q.col(i);
    const Eigen::Matrix3d thigh = JointRotation(hip, q);
    const Eigen::Matrix3d foot = thigh * JointRotation(knee, q) * JointRotation(ankle, q);
    SetJointRotation(hip, thigh * half, q);
    q(knee.first_dof) = 2 * kPi - q(knee.first_dof);
    const Eigen::Matrix3d shank = thigh * half * JointRotation(knee, q);
    SetJointRotation(ankle, shank.transpose() * foot, q);
    motion.q.col(i) = q;
  }
}

/// The furthest that a thigh turns from one frame to the next.
double LargestTurnRad(const Motion& motion) {
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  double largest_rad = 0;
  for (int side = 0; side < 2; ++side) {
    const body::Joint& hip =
        motion.skeleton.joint(landmarks[body::OfSide(Landmark::kLeftHip, side)]);
    for (Eigen::Index i = 1; i < motion.frames(); ++i) {
      const Eigen::AngleAxisd turned(JointRotation(hip, motion.q.col(i - 1)).transpose() *
                                     JointRotation(hip, motion.q.col(i)));
      largest_rad = std::max(largest_rad, turned.angle());
    }
  }
  return largest_rad;
}

/// How far the landmark is from where the other motion has it, in any frame.
double FurthestM(const Motion& a, const Motion& b, Landmark landmark) {
  const auto landmarks = body::FindLandmarks(a.skeleton).value();
  body::Kinematics at_a(a.skeleton), at_b(b.skeleton);
  double furthest_m = 0;
  for (Eigen::Index i = 0; i < a.frames(); ++i) {
    ComputeKinematics(a.skeleton, a.q.col(i), at_a);
    ComputeKinematics(b.skeleton, b.q.col(i), at_b);
    const std::size_t joint = Index(landmarks[landmark]);
    furthest_m = std::max(furthest_m, (at_a.p_WJ[joint] - at_b.p_WJ[joint]).norm());
  }
  return furthest_m;
}

TEST(HalfTurns, AThighThatTurnsByHalfIsTurnedBack) {
  const Motion squat = Squat();
  Motion turned = squat;
  TurnByHalf(0, 100, 140, turned);
  TurnByHalf(1, 118, 119, turned);
  ASSERT_GT(LargestTurnRad(turned), 3);
  const Motion mended = WithoutHalfTurns(turned);
  EXPECT_LT(LargestTurnRad(mended), 0.1);
  for (const Landmark joint :
       {Landmark::kLeftKnee, Landmark::kRightKnee, Landmark::kLeftAnkle, Landmark::kRightAnkle}) {
    EXPECT_LT(FurthestM(turned, mended, joint), 1e-9) << body::LandmarkName(joint);
    EXPECT_LT(FurthestM(squat, mended, joint), 1e-9) << body::LandmarkName(joint);
  }
  // The ankle has two angles, which cannot turn a foot about the shank.
  EXPECT_LT(FurthestM(squat, mended, Landmark::kLeftToe), 0.02);
  EXPECT_LT(FurthestM(squat, mended, Landmark::kRightToe), 0.02);
}

TEST(HalfTurns, AMotionWithoutThemStaysAsItIs) {
  const Motion squat = Squat();
  EXPECT_EQ(WithoutHalfTurns(squat).q, squat.q);
}

TEST(HalfTurns, ALegWhoseOtherSolutionHasTheAnkleElsewhereStaysAsItIs) {
  Motion motion = Squat();
  TurnByHalf(0, 100, 140, motion);
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const int ankle = landmarks[Landmark::kLeftAnkle];
  motion.skeleton.joints[Index(ankle)].offset_m.x() += 0.05;  // No longer below the knee.
  EXPECT_EQ(WithoutHalfTurns(motion).q, motion.q);
}

TEST(HalfTurns, ASkeletonWithoutLegsStaysAsItIs) {
  Motion motion = Squat();
  TurnByHalf(0, 100, 140, motion);
  for (body::Joint& joint : motion.skeleton.joints) joint.name = "part of " + joint.name;
  EXPECT_EQ(WithoutHalfTurns(motion).q, motion.q);
}

TEST(HalfTurns, NoRecordedThighTurnsByHalfOnceItIsRead) {
  SKIP_WITHOUT_SHARED_DATA();
  const std::string folder = test::SharedData() + "/mocap/hdm05/";
  int clips = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.find("_dg_squat") == std::string::npos || entry.path().extension() != ".amc") continue;
    const auto loaded =
        motion_files::LoadMotion(entry.path().string(), {.skeleton = folder + "HDM_dg.asf"});
    ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    EXPECT_LT(LargestTurnRad(loaded->motion), 0.5) << name;
    ++clips;
  }
  EXPECT_EQ(clips, 12);
}

}  // namespace
}  // namespace footing::motion
