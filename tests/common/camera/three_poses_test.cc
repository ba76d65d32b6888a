#include "common/camera/three_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/common/camera/boards.h"

namespace footing::camera_pose {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

const Vector3d kOrigin(0.1, 0, 1.2);

ThreePoses Seen(const Vector3d& ahead, const Vector3d& left) {
  ThreePoses poses;
  poses.p_WO_m = kOrigin;
  poses.origin = SeenAt(kTrue, kOrigin);
  poses.ahead = SeenAt(kTrue, kOrigin + ahead);
  poses.left = SeenAt(kTrue, kOrigin + left);
  return poses;
}

TEST(ThreePoses, GiveTheTruePoseWithoutNoise) {
  // The third need not be at a right angle: only its side counts.
  const auto pose = FromThreePoses(Seen({0.4, 0, 0}, {0.1, 0.4, 0}));
  ASSERT_TRUE(pose) << pose.error().message;
  EXPECT_TRUE(pose->X_WC.isApprox(kTrue, 1e-9));
}

TEST(ThreePoses, CovarianceIsThatOfItsErrors) {
  noise::Random random(5);
  const Vector3d hand(0.2, 0.3, 1.4);
  double nees = 0;
  constexpr int kTrials = 500;
  for (int i = 0; i < kTrials; ++i) {
    ThreePoses poses = Seen({0.5, 0, 0}, {0, 0.5, 0});
    poses.placement_sd_m = 0.005;
    for (SeenPoint* seen : {&poses.origin, &poses.ahead, &poses.left})
      seen->p_C_m += 0.005 * Normal3(random);
    for (SeenPoint* seen : {&poses.origin, &poses.ahead, &poses.left})
      seen->covariance_m2.setZero();
    const auto pose = FromThreePoses(poses);
    ASSERT_TRUE(pose) << pose.error().message;
    const Vector3d error = pose->X_WC * (kTrue.inverse() * hand) - hand;
    nees += error.dot(pose->CovarianceAt(hand).ldlt().solve(error)) / 3 / kTrials;
  }
  EXPECT_NEAR(nees, 1, 0.2);
}

TEST(ThreePoses, RefusesShortAnglesLengthsAndMirrors) {
  EXPECT_THAT(FromThreePoses(Seen({0.1, 0, 0}, {0, 0.4, 0})).error().message,
              HasSubstr("ahead is only 10.0 cm"));
  EXPECT_THAT(FromThreePoses(Seen({0.4, 0, 0}, {0.4, 0.2, 0})).error().message,
              HasSubstr("27 degrees apart"));
  EXPECT_THAT(FromThreePoses(Seen({0.4, 0, 0}, {0, -0.4, 0})).error().message,
              HasSubstr("on its head"));
  ThreePoses poses = Seen({0.4, 0, 0}, {0, 0.4, 0});
  poses.placement_sd_m = 0.001;
  poses.left_m = 0.38;
  EXPECT_THAT(FromThreePoses(poses).error().message,
              HasSubstr("to the left is seen 40.0 cm from the first place, and should be 38.0 cm"));
  // Seen with 10 mm along every axis the distance has 14 mm: 20 mm off are nothing.
  poses.left.covariance_m2 = poses.origin.covariance_m2 = 1e-4 * Eigen::Matrix3d::Identity();
  EXPECT_TRUE(FromThreePoses(poses));
  poses.left_m = 0.35;
  EXPECT_FALSE(FromThreePoses(poses)) << "50 mm are more than three times that";
}

}  // namespace
}  // namespace footing::camera_pose
