#include "common/virtual/devices/kinect_skeleton.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/body/skeleton_points.h"

namespace footing::virtual_sensors {
namespace {

using stream::BodyJoint;

constexpr int kExposures = 60'000;

struct KinectSkeletonTest : testing::Test {
  body::Body person = body::MakeBody(body::StandardPerson(1.75), {}).value();
  body::Kinematics at{person.skeleton};
  Eigen::VectorXd q = body::TPose(person.skeleton, person.landmarks);

  void SetUp() override { body::ComputeKinematics(person.skeleton, q, at); }
  void Sink(double by_m) {
    q(2) -= by_m;
    body::ComputeKinematics(person.skeleton, q, at);
  }
  static const KinectPoint& Of(const auto& seen, BodyJoint joint) {
    return seen[KinectSkeleton::kHands + body::IndexOf(joint)];
  }
};

TEST_F(KinectSkeletonTest, ATPoseFromTheFrontHidesNothing) {
  KinectSkeleton kinect(person, 1);
  const auto& seen = kinect.Expose(at);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    EXPECT_FALSE(seen[i].hidden) << i;
    EXPECT_EQ(seen[i].sd_m, KinectErrors::SdM());
  }
  EXPECT_FALSE(kinect.crouches());
}

TEST_F(KinectSkeletonTest, WhoCrouchesLosesTheLegsAndNothingElse) {
  KinectSkeleton kinect(person, 1);
  Sink(0.3);
  const auto& seen = kinect.Expose(at);
  EXPECT_TRUE(kinect.crouches());
  for (const BodyJoint joint : {BodyJoint::kLeftHip, BodyJoint::kRightKnee, BodyJoint::kLeftFoot}) {
    EXPECT_TRUE(Of(seen, joint).hidden);
    EXPECT_EQ(Of(seen, joint).sd_m, 3 * KinectErrors::SdM());
  }
  EXPECT_FALSE(Of(seen, BodyJoint::kHead).hidden);
  EXPECT_FALSE(Of(seen, BodyJoint::kLeftShoulder).hidden);
}

TEST_F(KinectSkeletonTest, FromTheSideOneLegAndArmHideTheOther) {
  KinectSkeleton kinect(person, 1, {.yaw_rad = kPi / 2});
  const auto& seen = kinect.Expose(at);
  EXPECT_FALSE(Of(seen, BodyJoint::kLeftKnee).hidden);
  EXPECT_TRUE(Of(seen, BodyJoint::kRightKnee).hidden);
  EXPECT_TRUE(Of(seen, BodyJoint::kRightShoulder).hidden);
  EXPECT_TRUE(seen[1].hidden) << "the right hand, behind head and trunk";
  KinectSkeleton knows(person, 1, {.hides = false, .yaw_rad = kPi / 2});
  for (const KinectPoint& point : knows.Expose(at)) EXPECT_FALSE(point.hidden);
}

TEST_F(KinectSkeletonTest, ItsErrorsHaveTheDeviationsThatItReports) {
  KinectSkeleton kinect(person, 5);
  Sink(0.3);
  double tracked = 0, inferred = 0;
  for (int i = 0; i < kExposures; ++i) {
    const auto& seen = kinect.Expose(at);
    const KinectPoint &head = Of(seen, BodyJoint::kHead), &knee = Of(seen, BodyJoint::kLeftKnee);
    tracked += (head.p_W_m - head.true_W_m).squaredNorm() / (3 * head.sd_m * head.sd_m);
    inferred += (knee.p_W_m - knee.true_W_m).squaredNorm() / (3 * knee.sd_m * knee.sd_m);
  }
  // 2000 s of errors that last 5 s: 400 looks at three axes, a deviation of sqrt(2 / 1200) = 0.04.
  EXPECT_NEAR(tracked / kExposures, 1, 0.2);
  EXPECT_NEAR(inferred / kExposures, 1, 0.2);
}

}  // namespace
}  // namespace footing::virtual_sensors
