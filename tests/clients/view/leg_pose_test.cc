#include "clients/view/scene/tally.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
namespace {

const Eigen::Vector3d kForward(1, 0, 0);

// Every length of the telescoping leg and every lean that a gait makes.
template <typename Check>
void ForEveryLeg(Check check) {
  for (double length_m = 0.55; length_m <= 1.1501; length_m += 0.01) {
    for (double lean_rad = -1.2; lean_rad <= 1.2; lean_rad += 0.3) {
      const Eigen::Vector3d hip(0.3, -0.1, 1.0);
      const Eigen::Vector3d down(std::sin(lean_rad), 0.2, -std::cos(lean_rad));
      check(hip, Eigen::Vector3d(hip + length_m * down.normalized()));
    }
  }
}

TEST(LegPose, BothSegmentsKeepTheirLengthAtEveryLegLength) {
  ForEveryLeg([](const Eigen::Vector3d& hip, const Eigen::Vector3d& foot) {
    const LegPose leg = SolveLeg(hip, foot, kForward);
    EXPECT_NEAR((leg.ankle_m - leg.hip_m).norm(), kLegSegmentM, 1e-12);
    EXPECT_NEAR((leg.foot_m - leg.ankle_m).norm(), kLegSegmentM, 1e-12);
  });
}

TEST(LegPose, TheFootStaysWhereThePhysicsPutIt) {
  ForEveryLeg([](const Eigen::Vector3d& hip, const Eigen::Vector3d& foot) {
    const LegPose leg = SolveLeg(hip, foot, kForward);
    EXPECT_EQ(leg.foot_m, foot);
    EXPECT_EQ(leg.hip_m, hip);
  });
}

TEST(LegPose, TheAnkleBendsBackwards) {
  ForEveryLeg([](const Eigen::Vector3d& hip, const Eigen::Vector3d& foot) {
    const LegPose leg = SolveLeg(hip, foot, kForward);
    const Eigen::Vector3d middle = (hip + foot) / 2;
    EXPECT_LT((leg.ankle_m - middle).dot(kForward), 0);
  });
}

TEST(LegPose, TheAnkleIsBehindTheMiddleByPythagoras) {
  const LegPose leg = SolveLeg({0, 0, 1}, {0, 0, 0}, kForward);
  // sqrt(0.60^2 - 0.50^2) = 0.33166 m behind the middle of a leg of 1 m.
  EXPECT_NEAR(leg.ankle_m.x(), -std::sqrt(0.60 * 0.60 - 0.50 * 0.50), 1e-12);
  EXPECT_NEAR(leg.ankle_m.y(), 0, 1e-12);
  EXPECT_NEAR(leg.ankle_m.z(), 0.5, 1e-12);
}

TEST(LegPose, ALegOfNoLengthAndOneTooLongStayFinite) {
  const LegPose folded = SolveLeg({0, 0, 1}, {0, 0, 1}, kForward);
  EXPECT_TRUE(folded.ankle_m.allFinite());
  const LegPose torn = SolveLeg({0, 0, 2}, {0, 0, 0}, kForward);
  EXPECT_TRUE(torn.ankle_m.isApprox(Eigen::Vector3d(0, 0, 1)));
  const LegPose along_forward = SolveLeg({0, 0, 1}, {0.8, 0, 1}, kForward);
  EXPECT_TRUE(along_forward.ankle_m.allFinite());
}

}  // namespace
}  // namespace footing::scene
