#include "common/base/rotation.h"

#include <gtest/gtest.h>

#include <numbers>

namespace footing {
namespace {

using Eigen::Vector3d;

TEST(LeastTurn, BringsOneDirectionToTheOtherWithoutTwist) {
  const Vector3d from(0.3, -2, 0.5), to(-1, 0.2, 4);
  const Eigen::Quaterniond turn = LeastTurn(from, to);
  EXPECT_TRUE((turn * from.normalized()).isApprox(to.normalized(), 1e-12));
  const Vector3d axis = from.cross(to).normalized();
  EXPECT_TRUE((turn * axis).isApprox(axis, 1e-12));
}

TEST(LeastTurn, OfOppositeDirectionsIsHalfATurn) {
  const Vector3d from(0, 3, 0), to(0, -1, 0);
  const Eigen::Quaterniond turn = LeastTurn(from, to);
  EXPECT_TRUE((turn * from.normalized()).isApprox(to, 1e-6));
  EXPECT_NEAR(Eigen::AngleAxisd(turn).angle(), std::numbers::pi, 1e-6);
}

TEST(LeastTurn, OfOneDirectionIsNone) {
  EXPECT_TRUE(LeastTurn(Vector3d(1, 2, 3), Vector3d(2, 4, 6))
                  .isApprox(Eigen::Quaterniond::Identity(), 1e-12));
}

TEST(CrossMatrix, TimesAVectorIsTheCrossProduct) {
  const Vector3d v(1, -2, 3), a(0.5, 4, -1);
  EXPECT_TRUE((CrossMatrix(v) * a).isApprox(v.cross(a), 1e-15));
}

}  // namespace
}  // namespace footing
