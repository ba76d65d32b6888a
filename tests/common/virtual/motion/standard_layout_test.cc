#include "common/virtual/motion/standard_layout.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>
#include <vector>

#include "common/base/rotation.h"
#include "common/base/units.h"
#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/edit.h"
#include "common/virtual/options/load.h"
#include "tests/common/virtual/motion/shared_data.h"

namespace footing::motion {
namespace {

/// Mean distance of the joints of the limbs in both motions, m.
double JointsApart(const Motion& a, const Motion& b) {
  const auto in_a = body::FindLandmarks(a.skeleton).value();
  const auto in_b = body::FindLandmarks(b.skeleton).value();
  body::Kinematics at_a(a.skeleton), at_b(b.skeleton);
  double sum = 0, count = 0;
  for (Eigen::Index t = 0; t < a.frames(); t += 10) {
    body::ComputeKinematics(a.skeleton, a.q.col(t), at_a);
    body::ComputeKinematics(b.skeleton, b.q.col(t), at_b);
    using body::Landmark;
    for (const Landmark left :
         {Landmark::kLeftHip, Landmark::kLeftKnee, Landmark::kLeftAnkle, Landmark::kLeftShoulder,
          Landmark::kLeftElbow, Landmark::kLeftWrist}) {
      for (const Landmark landmark : {left, body::Mirrored(left)}) {
        sum += (at_a.p_WJ[static_cast<std::size_t>(in_a[landmark])] -
                at_b.p_WJ[static_cast<std::size_t>(in_b[landmark])])
                   .norm();
        ++count;
      }
    }
  }
  return sum / count;
}

/// A person who stands, then squats in a boxer's guard, looking to the left.
Motion Guard() {
  Motion motion{body::StandardPerson(1.8), 60, 0, {}};
  const auto landmarks = body::FindLandmarks(motion.skeleton).value();
  const Eigen::VectorXd rest = body::TPose(motion.skeleton, landmarks);
  motion.q.resize(motion.skeleton.dof, 120);
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    const double done = std::min(1.0, static_cast<double>(t) / 20);
    Eigen::VectorXd q = rest;
    q(3) = kPi / 2;
    for (const int side : {0, 1}) {
      const auto dof = [&](body::Landmark left) {
        return motion.skeleton.joint(landmarks[body::OfSide(left, side)]).first_dof;
      };
      const double out = side == 0 ? 1 : -1;
      const Eigen::Vector3d ahead(0.3, 0.1 * out, -1);
      const body::Joint& shoulder =
          motion.skeleton.joint(landmarks[body::OfSide(body::Landmark::kLeftShoulder, side)]);
      const Eigen::Matrix3d now = body::JointRotation(shoulder, q);
      const Eigen::Quaterniond turn = LeastTurn(
          Eigen::Vector3d(0, out, 0), done * ahead + (1 - done) * Eigen::Vector3d(0, out, 0));
      // Forearms ahead and inwards, where the T-pose bends them up.
      const Eigen::Quaterniond twist(
          Eigen::AngleAxisd(2 * out * done, turn * Eigen::Vector3d(0, out, 0)));
      body::SetJointRotation(shoulder, (twist * turn).toRotationMatrix() * now, q);
      q(dof(body::Landmark::kLeftElbow)) = 2.6 * done;
      q(dof(body::Landmark::kLeftKnee)) = 0.9 * done;
    }
    q(2) -= 0.1 * done;
    motion.q.col(t) = q;
  }
  return motion;
}

/// The same movement of the same joints by a skeleton whose frames are turned at random on theirs,
/// so that its rest pose is not a person's.
Motion WithFramesTurned(const Motion& motion) {
  noise::Random random(7);
  std::vector<Eigen::Matrix3d> turns;
  std::vector<body::Joint> joints = motion.skeleton.joints;
  for (body::Joint& joint : joints) {
    turns.push_back(body::AxisRotation(body::Axis::kZ, random.Uniform(-kPi, kPi)) *
                    body::AxisRotation(body::Axis::kX, random.Uniform(-kPi, kPi)));
    if (joint.parent >= 0) {
      joint.offset_m = turns[static_cast<std::size_t>(joint.parent)].transpose() * joint.offset_m;
    }
    joint.axes.setIdentity();
    joint.rotations.clear();
    for (const body::Axis axis : {body::Axis::kZ, body::Axis::kX, body::Axis::kY}) {
      joint.rotations.push_back({axis, -body::kUnlimited, body::kUnlimited});
    }
  }
  Motion out{body::MakeSkeleton(std::move(joints)), motion.rate_hz, 0, {}};
  out.q = Eigen::MatrixXd::Zero(out.skeleton.dof, motion.frames());
  for (Eigen::Index t = 0; t < motion.frames(); ++t) {
    Eigen::VectorXd q = out.q.col(t);
    q.head<3>() = motion.q.col(t).head<3>();
    for (int i = 0; i < motion.skeleton.size(); ++i) {
      const body::Joint& joint = motion.skeleton.joint(i);
      Eigen::Matrix3d turn =
          body::JointRotation(joint, motion.q.col(t)) * turns[static_cast<std::size_t>(i)];
      if (joint.parent >= 0)
        turn = turns[static_cast<std::size_t>(joint.parent)].transpose() * turn;
      body::SetJointRotation(out.skeleton.joint(i), turn, q);
    }
    out.q.col(t) = q;
  }
  return out;
}

TEST(ToStandardLayout, KeepsTheJointsOfASkeletonWhoseRestPoseIsNoPerson) {
  const Motion person = Guard(), turned = WithFramesTurned(person);
  ASSERT_LT(JointsApart(person, turned), 1e-9);
  const auto standard = ToStandardLayout(turned);
  ASSERT_TRUE(standard) << standard.error().message;
  EXPECT_NEAR(standard->height_m, 1.8, 0.03);
  EXPECT_LT(standard->rms_m, 0.006);
  EXPECT_LT(JointsApart(person, standard->motion), 0.02);
  // Its elbows and knees bend as far, too.
  const auto at = body::FindLandmarks(standard->motion.skeleton).value();
  for (const body::Landmark joint : {body::Landmark::kLeftElbow, body::Landmark::kRightElbow,
                                     body::Landmark::kLeftKnee, body::Landmark::kRightKnee}) {
    const int dof = standard->motion.skeleton.joint(at[joint]).first_dof;
    EXPECT_NEAR(standard->motion.q(dof, 119), person.q(dof, 119), 0.15)
        << body::LandmarkName(joint);
  }
}

TEST(ToStandardLayout, KeepsTheJointsOfAnotherSkeletonsMotion) {
  // GIVEN a character of an animation program, of 84 degrees of freedom and another axis for all.
  SKIP_WITHOUT_SHARED_DATA();
  const auto loaded = motion_files::LoadMotion(test::SharedData() + "/mocap/cmu_bvh/002_04.bvh");
  ASSERT_TRUE(loaded);
  const auto motion = WithLandmarksOnly(loaded->motion).value();
  ASSERT_FALSE(HasStandardLayout(motion));
  const auto standard = ToStandardLayout(motion);
  ASSERT_TRUE(standard) << standard.error().message;
  EXPECT_TRUE(HasStandardLayout(standard->motion));
  EXPECT_EQ(standard->motion.frames(), motion.frames());
  EXPECT_LT(standard->rms_m, 0.008);
  EXPECT_LT(JointsApart(motion, standard->motion), 0.02);
}

}  // namespace
}  // namespace footing::motion
