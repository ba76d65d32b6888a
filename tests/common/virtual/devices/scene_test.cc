#include "common/virtual/devices/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "common/body/kinematics.h"
#include "common/virtual/motion/leg_solver.h"

namespace footing::virtual_sensors {
namespace {

// The standard person stands still for a second, somewhere, above the floor, turned.
motion::Motion Clip() {
  motion::Motion clip;
  clip.skeleton = body::StandardPerson(1.75);
  clip.rate_hz = 100;
  Eigen::VectorXd q = body::TPose(clip.skeleton, body::FindLandmarks(clip.skeleton).value());
  q.head<3>() += Eigen::Vector3d(2, -1, 0.3);
  q(3) = 0.7;
  clip.q = q.replicate(1, 100);
  return clip;
}

TEST(MakeScene, PutsATPoseInFrontWithTheWeightOverTheSoles) {
  const auto scene = MakeScene(Clip(), {}, {}, "clip");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_NEAR(scene->motion.duration_s(), 6 + 1.5 + 1, 0.011);
  const double weight_n = 75 * kStandardGravityMps2;
  EXPECT_NEAR(scene->reaction.force_n(2, 300), weight_n, 0.5);
  const Eigen::Vector3d left = SoleMiddle(scene->course, 0, 300);
  const Eigen::Vector3d right = SoleMiddle(scene->course, 1, 300);
  EXPECT_NEAR(left.z(), 0, 5e-3);
  EXPECT_GT(left.y() - right.y(), 0.1);  // It looks along x.
  // 0.42 of heel to toe is 8 % of a sole of 24 cm behind its middle.
  EXPECT_NEAR(scene->course.com_m(0, 300), left.x() - 0.02, 0.01);
}

// Both legs apart, and the left one turned out: stands unlike the T-pose.
motion::Motion Straddling() {
  motion::Motion clip = Clip();
  const body::Landmarks landmarks = body::FindLandmarks(clip.skeleton).value();
  for (const double side : {1.0, -1.0}) {
    const body::Landmark hip = body::OfSide(body::Landmark::kLeftHip, side > 0 ? 0 : 1);
    const body::Joint& joint = clip.skeleton.joint(landmarks[hip]);
    Eigen::VectorXd q = clip.q.col(0);
    const Eigen::Matrix3d turn = body::AxisRotation(body::Axis::kZ, side > 0 ? 0.4 : 0) *
                                 body::AxisRotation(body::Axis::kX, side * 0.2);
    body::SetJointRotation(joint, turn * body::JointRotation(joint, q), q);
    clip.q = q.replicate(1, 100);
  }
  return clip;
}

TEST(MakeScene, NoFootSlidesFromTheTPoseIntoTheClip) {
  const auto scene = MakeScene(Straddling(), {}, {}, "clip");
  ASSERT_TRUE(scene) << scene.error().message;
  const BodyCourse& course = scene->course;
  const Eigen::Index last = course.frames() - 1;
  const auto heading = [&](std::size_t foot, Eigen::Index frame) {  // From heel to ball.
    const auto& sole = course.sole_m[foot];
    const Eigen::Vector3d ahead = sole[2].col(frame) - sole[0].col(frame);
    return std::atan2(ahead.y(), ahead.x());
  };
  const double apart_m = SoleMiddle(course, 0, 0).y() - SoleMiddle(course, 1, 0).y();
  EXPECT_GT(apart_m, 0.4);
  EXPECT_GT(heading(0, 0) - heading(1, 0), 0.3);
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const Eigen::Vector2d stands_m = SoleMiddle(course, foot, last).head<2>();
    for (Eigen::Index i = 0; i < course.frames(); i += 10) {
      // The clip's legs have their feet on edge, the T-pose has them flat.
      EXPECT_LT((SoleMiddle(course, foot, i).head<2>() - stands_m).norm(), 0.04) << i;
      EXPECT_NEAR(heading(foot, i), heading(foot, last), 0.05) << i;
    }
    EXPECT_NEAR(SoleMiddle(course, foot, 300).z(), 0, 0.01);
  }
}

TEST(MakeScene, ThighsAreTurnedInTheTPoseAsTheClipBegins) {
  const auto scene = MakeScene(Straddling(), {}, {}, "clip");
  ASSERT_TRUE(scene) << scene.error().message;
  const body::Landmarks& landmarks = scene->body.landmarks;
  const motion::Motion& motion = scene->motion;
  body::Kinematics at(scene->body.skeleton);
  for (std::size_t foot = 0; foot < kFeet; ++foot) {
    const motion::LegSolver leg(scene->body, foot == 0);
    const auto place = [&](body::Landmark left) -> Eigen::Vector3d {
      const int joint = landmarks[body::OfSide(left, static_cast<int>(foot))];
      return at.p_WJ[static_cast<std::size_t>(joint)];
    };
    for (Eigen::Index i = 0; i < motion.frames(); i += 10) {
      body::ComputeKinematics(motion.skeleton, motion.q.col(i), at);
      EXPECT_NEAR(leg.ThighTurn(at), foot == 0 ? 0.4 : 0, 0.02) << i;
      const Eigen::Vector3d hip_m = place(body::Landmark::kLeftHip);
      const Eigen::Vector3d way_m = place(body::Landmark::kLeftAnkle) - hip_m;
      const Eigen::Vector3d knee_m = place(body::Landmark::kLeftKnee) - hip_m;
      const double ahead_m = knee_m.x() - way_m.x() * knee_m.z() / way_m.z();
      EXPECT_GT(ahead_m, -1e-3) << i;  // Straight or bent, never backwards.
    }
  }
}

TEST(MakeScene, LeavesAClipThatBeginsInATPoseAsItIs) {
  SceneOptions options;
  options.t_pose = false;
  const auto scene = MakeScene(Clip(), {}, options, "clip");
  ASSERT_TRUE(scene);
  EXPECT_LT((scene->motion.q - Clip().q).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(MakeScene, ErrorsNameTheClip) {
  motion::Motion one = Clip();
  one.q = Eigen::MatrixXd(one.q.leftCols(1));
  const auto scene = MakeScene(one, {}, {}, "walk.bvh");
  ASSERT_FALSE(scene);
  EXPECT_THAT(scene.error().message, testing::HasSubstr("walk.bvh: a motion needs two frames"));
  motion::Motion nobody = Clip();
  for (auto& joint : nobody.skeleton.joints) joint.name = "x";
  EXPECT_THAT(MakeScene(nobody, {}, {}, "walk.bvh").error().message,
              testing::HasSubstr("walk.bvh: "));
}

TEST(Shift, MovesEverythingThatHasAPlace) {
  auto scene = MakeScene(Clip(), {}, {}, "clip");
  ASSERT_TRUE(scene);
  const Scene before = *scene;
  const auto feet_before = ShareThroughout(before);
  Shift({0.5, -0.25}, *scene);
  const auto feet = ShareThroughout(*scene);
  const Eigen::Vector2d by(0.5, -0.25);
  EXPECT_EQ(Eigen::Vector2d(scene->motion.q.col(9).head<2>()),
            Eigen::Vector2d(before.motion.q.col(9).head<2>() + by));
  for (std::size_t f = 0; f < kFeet; ++f) {
    EXPECT_NEAR((feet[300][f].cop_m - feet_before[300][f].cop_m - by).norm(), 0, 1e-9);
    EXPECT_NEAR(feet[300][f].load_n, feet_before[300][f].load_n, 1e-6);
  }
  EXPECT_NEAR((scene->course.com_m.col(300) - before.course.com_m.col(300)).head<2>().norm(),
              by.norm(), 1e-12);
}

TEST(ShareThroughout, HasAnEntryAFrame) {
  const auto scene = MakeScene(Clip(), {}, {}, "clip");
  ASSERT_TRUE(scene);
  const auto feet = ShareThroughout(*scene);
  ASSERT_EQ(feet.size(), static_cast<std::size_t>(scene->course.frames()));
  EXPECT_NEAR(feet[300][0].load_n + feet[300][1].load_n, 75 * kStandardGravityMps2, 0.5);
}

}  // namespace
}  // namespace footing::virtual_sensors
