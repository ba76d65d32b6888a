#include "common/body/skeleton.h"

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "tests/common/body/poses.h"

namespace footing::body {
namespace {

using test::RandomVector;

Skeleton ThreeAxisJoint(Axis a, Axis b, Axis c) {
  Joint root;
  root.name = "root";
  root.rotations = {{a}, {b}, {c}};
  return MakeSkeleton({root});
}

TEST(Skeleton, EveryOrderOfThreeAxesIsTakenApartAgain) {
  noise::Random random(1);
  const Axis axes[] = {Axis::kX, Axis::kY, Axis::kZ};
  for (Axis a : axes) {
    for (Axis b : axes) {
      for (Axis c : axes) {
        if (a == b || b == c || a == c) continue;
        const Skeleton skeleton = ThreeAxisJoint(a, b, c);
        for (int i = 0; i < 100; ++i) {
          const Eigen::VectorXd q = RandomVector(skeleton.dof, 7, random);
          const Eigen::Matrix3d R = JointRotation(skeleton.joint(0), q);
          // Nearby angles lead back to the very same ones, whole turns and the second triple too.
          Eigen::VectorXd found = q + RandomVector(skeleton.dof, 0.1, random);
          SetJointRotation(skeleton.joint(0), R, found);
          EXPECT_TRUE(JointRotation(skeleton.joint(0), found).isApprox(R, 1e-9));
          if (std::abs(std::cos(q(4))) > 0.2) {
            EXPECT_LT((found - q).tail(3).cwiseAbs().maxCoeff(), 1e-9);
          }
        }
      }
    }
  }
}

TEST(Skeleton, ALockedRotationIsStillMet) {
  const Skeleton skeleton = ThreeAxisJoint(Axis::kZ, Axis::kX, Axis::kY);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(6);
  q.tail(3) << 0.4, kPi / 2, -0.7;
  const Eigen::Matrix3d R = JointRotation(skeleton.joint(0), q);
  Eigen::VectorXd found = q;
  found.tail(3) += Eigen::Vector3d(0.1, 0, 0.05);
  SetJointRotation(skeleton.joint(0), R, found);
  EXPECT_TRUE(JointRotation(skeleton.joint(0), found).isApprox(R, 1e-7));
  EXPECT_NEAR(found(5), -0.65, 1e-9);  // The third angle stays where it was.
}

TEST(Skeleton, AHingeTakesTheNearestAngle) {
  Joint root;
  root.axes = AxisRotation(Axis::kX, 0.3);
  root.rotations = {{Axis::kY}};
  const Skeleton skeleton = MakeSkeleton({root});
  Eigen::VectorXd q = Eigen::VectorXd::Zero(4);
  q(3) = 1.2;
  const Eigen::Matrix3d R = JointRotation(skeleton.joint(0), q);
  Eigen::VectorXd found = Eigen::VectorXd::Zero(4);
  SetJointRotation(skeleton.joint(0), R, found);
  EXPECT_NEAR(found(3), 1.2, 1e-12);
}

TEST(Skeleton, EveryDegreeOfFreedomHasANameOfItsOwn) {
  const Skeleton skeleton = StandardPerson(1.7);
  auto names = DofNames(skeleton);
  ASSERT_EQ(static_cast<int>(names.size()), skeleton.dof);
  EXPECT_EQ(names[0], "root.x_m");
  EXPECT_EQ(names[3], "root.z_rad");
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace footing::body
