#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/asf.h"
#include "common/virtual/motion/bvh.h"
#include "common/virtual/motion/edit.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

/// A standard person whose every joint swings a little, each at its own phase.
Motion Swinging(double rate_hz, double seconds) {
  Motion motion{body::StandardPerson(1.75), rate_hz, 0, {}};
  const auto frames = static_cast<Eigen::Index>(seconds * rate_hz) + 1;
  motion.q.resize(motion.skeleton.dof, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    const double t_s = static_cast<double>(i) / rate_hz;
    for (int dof = 0; dof < motion.skeleton.dof; ++dof) {
      motion.q(dof, i) = 0.3 * std::sin(2 * kPi * 0.7 * t_s + dof) + 0.1;
    }
  }
  return motion;
}

std::vector<Eigen::Vector3d> Places(const Motion& motion, Eigen::Index frame) {
  body::Kinematics at(motion.skeleton);
  ComputeKinematics(motion.skeleton, motion.q.col(frame), at);
  return at.p_WJ;
}

double Largest(const std::vector<Eigen::Vector3d>& a, const std::vector<Eigen::Vector3d>& b) {
  double largest_m = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest_m = std::max(largest_m, (a[i] - b[i]).norm());
  return largest_m;
}

TEST(Edit, ContinuousAnglesMeanTheSame) {
  Motion motion = Swinging(60, 1);
  const Motion smooth = motion;
  for (Eigen::Index i = 0; i < motion.frames(); i += 2) {  // The other triple and whole turns.
    motion.q.col(i).segment<3>(3) += Eigen::Vector3d(kPi, 0, -kPi);
    motion.q(4, i) = kPi - motion.q(4, i);
    motion.q(20, i) += 2 * kPi * static_cast<double>(i % 3);
  }
  const Motion again = Continuous(motion);
  EXPECT_LT((again.q.rightCols(60) - again.q.leftCols(60)).cwiseAbs().maxCoeff(), 0.1);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    EXPECT_LT(Largest(Places(again, i), Places(smooth, i)), 1e-9);
  }
}

TEST(Edit, CanonicalAnglesAreTheSameHoweverTheyWereWritten) {
  const Motion plain = Swinging(60, 1);
  Motion turned = plain;
  turned.q.row(3).array() += kPi;  // The other triple of the root,
  turned.q.row(4) = (kPi - turned.q.row(4).array()).matrix();
  turned.q.row(5).array() -= kPi;
  for (const int dof : {12, 20, 33}) turned.q.row(dof).array() += 4 * kPi;  // and whole turns.
  EXPECT_GT((Continuous(turned).q - plain.q).cwiseAbs().maxCoeff(), 3);
  EXPECT_LT((Canonical(turned).q - plain.q).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((Canonical(plain).q - plain.q).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Edit, SmoothingKeepsASlowTurnThroughASingularPose) {
  Motion motion = Swinging(120, 2);
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const body::Joint& hip = motion.skeleton.joint(landmarks[body::Landmark::kLeftHip]);
  ASSERT_EQ(hip.rotations.size(), 3u);
  // Middle angles of a quarter turn, nearly, are where the other two mean the same.
  Eigen::VectorXd singular = Eigen::VectorXd::Zero(motion.skeleton.dof);
  singular(hip.first_dof + 1) = kPi / 2 - 0.02;
  const Eigen::Matrix3d middle = JointRotation(hip, singular);
  for (Eigen::Index i = 0; i < motion.frames(); ++i) {
    const double turn_rad = 0.6 * std::sin(kPi * static_cast<double>(i) / 120);
    const Eigen::AngleAxisd turned(turn_rad, Eigen::Vector3d(1, 2, 3).normalized());
    motion.q.col(i) = i > 0 ? motion.q.col(i - 1) : singular;
    SetJointRotation(hip, middle * turned.toRotationMatrix(), motion.q.col(i));
  }
  const Motion smooth = Smoothed(motion, 6);
  const Motion fast = Resampled(motion, 60);
  for (Eigen::Index i = 12; i < motion.frames() - 12; ++i) {
    EXPECT_LT(Largest(Places(smooth, i), Places(motion, i)), 0.002) << i;
    if (i % 2 != 0) continue;
    EXPECT_LT(Largest(Places(fast, i / 2), Places(motion, i)), 0.002) << i;
  }
}

TEST(Edit, ResamplingKeepsPlacesInTime) {
  const Motion motion = Swinging(120, 2);
  const Motion slow = Resampled(motion, 60);
  EXPECT_EQ(slow.frames(), 121);
  for (Eigen::Index i = 10; i < 110; ++i) {
    EXPECT_LT(Largest(Places(slow, i), Places(motion, 2 * i)), 1e-4);
  }
  const Motion back = Resampled(slow, 120);
  EXPECT_EQ(back.frames(), 241);
  for (Eigen::Index i = 20; i < 220; ++i) {
    EXPECT_LT(Largest(Places(back, i), Places(motion, i)), 1e-4);
  }
}

TEST(Edit, RatesAreTheDerivativesOfTheSwing) {
  const Motion motion = Swinging(120, 3);
  const MotionRates rates = Rates(motion);
  const double w = 2 * kPi * 0.7, t_s = 1.5;
  for (int dof = 0; dof < motion.skeleton.dof; ++dof) {
    EXPECT_NEAR(rates.q_dot(dof, 180), 0.3 * w * std::cos(w * t_s + dof), 1e-4);
    EXPECT_NEAR(rates.q_ddot(dof, 180), -0.3 * w * w * std::sin(w * t_s + dof), 0.01);
  }
}

TEST(Edit, AMirroredMotionIsTheMirrorImage) {
  Motion motion = Swinging(60, 1);
  motion.skeleton.joints[2].offset_m *= 1.1;  // Not the same left and right.
  const Motion mirrored = Mirrored(motion);
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  for (Eigen::Index frame : {0, 17, 60}) {
    const auto here = Places(motion, frame), there = Places(mirrored, frame);
    for (int i = 0; i < body::kLandmarkCount; ++i) {
      const auto landmark = static_cast<body::Landmark>(i);
      const Eigen::Vector3d a = here[static_cast<std::size_t>(landmarks[landmark])];
      const Eigen::Vector3d b =
          there[static_cast<std::size_t>(landmarks[body::Mirrored(landmark)])];
      EXPECT_LT((a - Eigen::Vector3d(b.x(), -b.y(), b.z())).norm(), 1e-9)
          << body::LandmarkName(landmark);
    }
  }
  const Motion twice = Mirrored(mirrored);
  EXPECT_LT(Largest(Places(twice, 30), Places(motion, 30)), 1e-9);
}

TEST(Edit, ALoopComesBackWithoutAJumpOfVelocity) {
  const Motion motion = Swinging(100, 4);
  const Motion loop = Looped(motion, 30);
  EXPECT_EQ(loop.frames(), 3001);
  // One way takes 4 s and 0.5 s more at each end: back at the start after 10 s.
  EXPECT_LT((loop.q.col(1000) - motion.q.col(0)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((loop.q.col(500) - motion.q.col(400)).cwiseAbs().maxCoeff(), 1e-9);
  const Eigen::MatrixXd v = (loop.q.rightCols(3000) - loop.q.leftCols(3000)) * 100;
  // Speed changes from 1 to 0 of the clip's own (1.3 rad/s at most) over 1 s, and its own
  // acceleration is 5.8 rad/s^2 at most: below 0.08 a frame. A plain turn would jump by 2.6.
  EXPECT_LT((v.rightCols(2999) - v.leftCols(2999)).cwiseAbs().maxCoeff(), 0.08);
  const Motion plain = Looped(motion, 9, 0);
  EXPECT_LT((plain.q.col(800) - motion.q.col(0)).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT((plain.q.col(401) - motion.q.col(399)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Edit, FacingForwardLooksAlongX) {
  Motion motion = Swinging(60, 3);
  motion.q.row(3).array() += 2.5;
  motion.q.row(0).array() += 3;
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const Motion forward = FacingForward(motion, landmarks);
  const auto middle = Places(forward, 90);
  const Eigen::Vector3d left =
      middle[static_cast<std::size_t>(landmarks[body::Landmark::kLeftHip])];
  const Eigen::Vector3d right =
      middle[static_cast<std::size_t>(landmarks[body::Landmark::kRightHip])];
  EXPECT_GT((left - right).normalized().y(), 0.8);  // Less its own swing.
  EXPECT_LT(((left + right) / 2).head<2>().norm(), 0.5);
  // A rigid move: distances stay.
  const auto before = Places(motion, 90);
  EXPECT_NEAR((middle[10] - middle[30]).norm(), (before[10] - before[30]).norm(), 1e-9);
  EXPECT_NEAR(middle[10].z(), before[10].z(), 1e-9);
}

TEST(Edit, ACmuSkeletonWithLandmarksOnlyIsAStandardPersons) {
  SKIP_WITHOUT_SHARED_DATA();
  const auto asf = ParseAsf(test::ReadShared("mocap/cmu_amc/01.asf"), "01");
  const auto motion = ParseAmc(test::ReadShared("mocap/cmu_amc/01_01.amc"), "01_01", *asf).value();
  const auto plain = WithLandmarksOnly(motion);
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  const body::Skeleton standard = body::StandardPerson(1.75);
  EXPECT_EQ(body::DofNames(plain->skeleton), body::DofNames(standard));
  ASSERT_EQ(plain->skeleton.size(), standard.size());
  const auto here = Places(motion, 500), there = Places(*plain, 500);
  for (int i = 0; i < standard.size(); ++i) {
    EXPECT_EQ(plain->skeleton.joint(i).name, standard.joint(i).name);
    const int in_file = body::FindJoint(motion.skeleton, standard.joint(i).name);
    if (in_file < 0) continue;
    EXPECT_LT((here[static_cast<std::size_t>(in_file)] - there[static_cast<std::size_t>(i)]).norm(),
              1e-12);
  }
}

TEST(Edit, AHumanoidRestsInATPoseAndMovesAsBefore) {
  const Motion motion = Swinging(20, 1);
  const auto humanoid = Humanoid(motion);
  ASSERT_TRUE(humanoid.ok()) << humanoid.error().message;
  const body::Skeleton& skeleton = humanoid->skeleton;
  // The bones that Unity needs of every humanoid, and others that it knows.
  for (const char* name :
       {"Hips",          "Spine",         "Chest",         "UpperChest",    "Neck",
        "Head",          "LeftShoulder",  "LeftUpperArm",  "LeftLowerArm",  "LeftHand",
        "RightUpperArm", "RightLowerArm", "RightHand",     "LeftUpperLeg",  "LeftLowerLeg",
        "LeftFoot",      "LeftToes",      "RightUpperLeg", "RightLowerLeg", "RightFoot"}) {
    EXPECT_GE(body::FindJoint(skeleton, name), 0) << name;
  }
  const auto bone = [&](const char* from, const char* to) -> Eigen::Vector3d {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const int first = body::FindJoint(skeleton, from);
    for (int i = body::FindJoint(skeleton, to); i > first; i = skeleton.joint(i).parent) {
      sum += skeleton.joint(i).offset_m;
    }
    return sum.normalized();
  };
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY(), up = Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(bone("LeftUpperArm", "LeftHand").dot(left), 1, 1e-9);
  EXPECT_NEAR(bone("RightUpperArm", "RightHand").dot(-left), 1, 1e-9);
  EXPECT_NEAR(bone("LeftUpperLeg", "LeftFoot").dot(-up), 1, 1e-9);
  EXPECT_NEAR(bone("RightUpperLeg", "RightFoot").dot(-up), 1, 1e-9);
  EXPECT_GT(bone("LeftFoot", "LeftToes").x(), 0.8);
  EXPECT_GT(bone("Spine", "Head").dot(up), 0.99);
  for (Eigen::Index frame = 0; frame < motion.frames(); ++frame) {
    const auto here = Places(motion, frame), there = Places(*humanoid, frame);
    for (std::size_t i = 0; i < here.size(); ++i) EXPECT_LT((here[i] - there[i]).norm(), 1e-9);
  }
  // Another reader finds the same person in it.
  const auto read = ParseBvh(WriteBvh(*humanoid), "humanoid.bvh");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_TRUE(body::FindLandmarks(read->skeleton).ok());
}

TEST(Edit, AnyRigWithLandmarksOnlyLosesItsHelpers) {
  SKIP_WITHOUT_SHARED_DATA();
  for (const char* path : {"mocap/mass_bvh/walk.bvh", "mocap/cmu_bvh/002_04.bvh"}) {
    const auto motion = ParseBvh(test::ReadShared(path), path).value();
    const auto plain = WithLandmarksOnly(motion);
    ASSERT_TRUE(plain.ok()) << plain.error().message;
    EXPECT_LT(plain->skeleton.dof, 85) << path;
    EXPECT_TRUE(body::MakeBody(plain->skeleton, {}).ok()) << path;
  }
}

Eigen::MatrixXd Sine(double frequency_hz, double rate_hz, Eigen::Index frames) {
  Eigen::MatrixXd signal(1, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    signal(0, i) = std::sin(2 * kPi * frequency_hz * static_cast<double>(i) / rate_hz);
  }
  return signal;
}

TEST(Spline, MeetsASineAndItsDerivatives) {
  const Spline spline(Sine(1, 100, 401), 100);
  const double w = 2 * kPi;
  for (double t_s : {0.503, 1.25, 2.777, 3.4}) {
    EXPECT_NEAR(spline.Value(t_s)(0), std::sin(w * t_s), 1e-6);
    EXPECT_NEAR(spline.FirstDerivative(t_s)(0), w * std::cos(w * t_s), 1e-3);
    EXPECT_NEAR(spline.SecondDerivative(t_s)(0), -w * w * std::sin(w * t_s), 0.05);
  }
  EXPECT_NEAR(spline.Value(0.31)(0), std::sin(w * 0.31), 1e-6);  // A sample.
  EXPECT_EQ(spline.Value(99)(0), spline.Value(4)(0));
}

TEST(Spline, OneSampleIsAConstant) {
  const Spline spline(Eigen::MatrixXd::Constant(2, 1, 7), 100);
  EXPECT_EQ(spline.Value(3)(1), 7);
  EXPECT_EQ(spline.FirstDerivative(3)(1), 0);
}

}  // namespace
}  // namespace footing::motion
