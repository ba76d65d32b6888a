#include "daemon/sensor/features/grip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "common/base/units.h"

/// How two controllers lie in their hands, rotated about their fronts.
namespace footing::features {
namespace {

using Eigen::Vector3d;

/// Gravity in S of a forearm `raised_deg` above hanging, whose controller is rotated by `grip_deg`.
Vector3d Gravity(double raised_deg, double grip_deg) {
  const double raised_rad = DegreesToRadians(raised_deg);
  const Vector3d buttons_up(0, -std::cos(raised_rad), -std::sin(raised_rad));
  return kStandardGravityMps2 *
         (Eigen::AngleAxisd(DegreesToRadians(grip_deg), Vector3d::UnitY()) * buttons_up);
}

PairGrip After(double seconds, const Vector3d& left, const Vector3d& right, PairGrip grip = {}) {
  for (double t_s = 0; t_s < seconds; t_s += 0.01) grip = Next(grip, left, right, false, 0.01, {});
  return grip;
}

/// A force that both hands feel along the same way of their forearms, as the right one reads it.
TEST(PairGrip, BringsTheRightSensorsAxesToThoseOfTheLeftHand) {
  const Vector3d force(3, -2, 5);
  for (const double raised_deg : {15.0, 85.0}) {
    for (const double left_deg : {-45.0, 0.0, 45.0}) {
      for (const double right_deg : {-45.0, 0.0, 45.0, 60.0}) {
        const PairGrip grip =
            After(0.1, Gravity(raised_deg, left_deg), Gravity(raised_deg, right_deg));
        const auto read = [&](double grip_deg) -> Vector3d {
          return Eigen::AngleAxisd(DegreesToRadians(grip_deg), Vector3d::UnitY()) * force;
        };
        EXPECT_LT((grip.FromRight() * read(right_deg) - read(left_deg)).norm(), 1e-9)
            << raised_deg << " degrees raised, grips " << left_deg << ", " << right_deg;
      }
    }
  }
}

TEST(PairGrip, IsNoneUntilGravityShowsIt) {
  EXPECT_EQ(PairGrip().FromRight(), Eigen::Matrix3d::Identity());
  // Forearms that hang straight down show nothing, and one hand alone neither.
  EXPECT_EQ(After(1, Gravity(3, 45), Gravity(3, -45)).seen_s, 0);
  EXPECT_EQ(Next({}, Gravity(85, 45), std::nullopt, false, 0.01, {}).seen_s, 0);
}

TEST(PairGrip, OfHandsAtRestCountsUntilTheySwing) {
  const Vector3d left = Gravity(85, 45), right = Gravity(85, -45), level = Gravity(85, 0);
  // The moment in which a swing begins is not a rest.
  PairGrip rest = Next({}, left, right, true, 0.01, {});
  EXPECT_EQ(rest.seen_s, 0);
  for (int i = 0; i < 40; ++i) rest = Next(rest, left, right, true, 0.01, {});
  EXPECT_NEAR(std::arg(rest.turn_m2ps4), std::arg(After(1, left, right).turn_m2ps4), 1e-9);
  // Swings of a few seconds outweigh what the rest before them showed,
  const PairGrip swung = After(4, level, level, rest);
  EXPECT_NEAR(std::arg(swung.turn_m2ps4), 0, DegreesToRadians(5));
  // and remotes that are put down between two of them change nothing.
  EXPECT_EQ(Next(swung, left, right, true, 0.01, {}).turn_m2ps4, swung.turn_m2ps4);
}

}  // namespace
}  // namespace footing::features
