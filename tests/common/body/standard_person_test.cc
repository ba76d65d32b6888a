#include <gtest/gtest.h>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "tests/common/body/poses.h"

namespace footing::body {
namespace {

class EverySex : public testing::TestWithParam<Sex> {};

TEST_P(EverySex, HasFiftySixDegreesOfFreedomAndTheHeightAskedFor) {
  const Skeleton skeleton = StandardPerson(1.68, GetParam());
  EXPECT_EQ(skeleton.dof, 56);
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  double top_m = 0, bottom_m = 9;
  for (const Eigen::Vector3d& p_W : at.p_WJ) {
    top_m = std::max(top_m, p_W.z());
    bottom_m = std::min(bottom_m, p_W.z());
  }
  EXPECT_NEAR(bottom_m, 0, 1e-9);
  // The lowest joint is the ball of the foot, 0.015 of the height over the sole.
  EXPECT_NEAR(top_m, 1.68 * (1 - 0.015), 0.005);
}

TEST_P(EverySex, IsTheSameLeftAndRight) {
  const Skeleton skeleton = StandardPerson(1.75, GetParam());
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  for (int i = 0; i < kLandmarkCount; ++i) {
    const auto landmark = static_cast<Landmark>(i);
    const Eigen::Vector3d here = at.p_WJ[static_cast<std::size_t>(landmarks[landmark])];
    const Eigen::Vector3d there = at.p_WJ[static_cast<std::size_t>(landmarks[Mirrored(landmark)])];
    EXPECT_LT((here - Eigen::Vector3d(there.x(), -there.y(), there.z())).norm(), 1e-9)
        << LandmarkName(landmark);
  }
}

TEST_P(EverySex, LooksAheadWithArmsOutAndToesInFront) {
  const Skeleton skeleton = StandardPerson(1.75, GetParam());
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Kinematics at(skeleton);
  ComputeKinematics(skeleton, TPose(skeleton, landmarks), at);
  const auto place = [&](Landmark l) { return at.p_WJ[static_cast<std::size_t>(landmarks[l])]; };
  EXPECT_GT(place(Landmark::kLeftHandEnd).y(), 0.75);
  EXPECT_NEAR(place(Landmark::kLeftHandEnd).z(), place(Landmark::kLeftShoulder).z(), 1e-6);
  EXPECT_GT(place(Landmark::kLeftToeEnd).x(), place(Landmark::kLeftAnkle).x() + 0.15);
  EXPECT_NEAR(place(Landmark::kLeftKnee).y(), place(Landmark::kLeftHip).y(), 1e-6);
}

TEST(StandardPerson, AKneeBendsBackAndAnElbowInFront) {
  const Skeleton skeleton = StandardPerson(1.75);
  const Landmarks landmarks = FindLandmarks(skeleton).value();
  Eigen::VectorXd q = TPose(skeleton, landmarks);
  Kinematics straight(skeleton), bent(skeleton);
  ComputeKinematics(skeleton, q, straight);
  const auto knee = skeleton.joint(landmarks[Landmark::kLeftKnee]).first_dof;
  q(knee) = 1;
  ComputeKinematics(skeleton, q, bent);
  const auto ankle = static_cast<std::size_t>(landmarks[Landmark::kLeftAnkle]);
  EXPECT_LT(bent.p_WJ[ankle].x(), straight.p_WJ[ankle].x() - 0.2);
}

INSTANTIATE_TEST_SUITE_P(Sexes, EverySex, testing::Values(Sex::kFemale, Sex::kMale, Sex::kMean));

}  // namespace
}  // namespace footing::body
