#include "common/virtual/devices/ground_reaction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::virtual_sensors {
namespace {

constexpr double kRateHz = 120;
constexpr double kMassKg = 70;
constexpr Eigen::Index kFrames = 600;

// Feet 32 cm apart, soles 22 cm long, flat.
BodyCourse Standing() {
  BodyCourse course;
  course.rate_hz = kRateHz;
  course.mass_kg = kMassKg;
  course.com_m = Eigen::Vector3d(0.04, 0, 1).replicate(1, kFrames);
  course.angular_momentum.setZero(3, kFrames);
  for (std::size_t f = 0; f < kFeet; ++f)
    for (std::size_t i = 0; i < kFootPoints; ++i)
      course.sole_m[f][i] =
          Eigen::Vector3d(i < 2 ? -0.05 : 0.17,
                          (f == 0 ? 0.16 : -0.16) + (i % 2 == 0 ? 0.03 : -0.03), 0)
              .replicate(1, kFrames);
  return course;
}

TEST(React, GivesTheWeightUnderTheCentreOfMassAtRest) {
  const BodyCourse course = Standing();
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.force_n(2, 300), kMassKg * kStandardGravityMps2, 1e-6);
  EXPECT_NEAR(reaction.cop_m(0, 300), 0.04, 1e-9);
  EXPECT_TRUE(reaction.supported[300]);
}

TEST(React, CopOvershootsASwayingPointMassByItsFrequencySquaredOverGravity) {
  BodyCourse course = Standing();
  const double w = 2 * kPi * 0.5;
  for (Eigen::Index i = 0; i < kFrames; ++i)
    course.com_m(1, i) = 0.05 * std::sin(w * static_cast<double>(i) / kRateHz);
  const GroundReaction reaction = React(course, 20);
  const double factor = 1 + w * w / kStandardGravityMps2;
  for (Eigen::Index i = 100; i < 500; ++i)
    EXPECT_NEAR(reaction.cop_m(1, i), factor * course.com_m(1, i), 2e-4);
}

TEST(React, AngularMomentumMovesTheCop) {
  BodyCourse course = Standing();
  // L_y grows by 7 N m: with 686.5 N the COP moves back by 1.02 cm.
  for (Eigen::Index i = 0; i < kFrames; ++i)
    course.angular_momentum(1, i) = 7 * static_cast<double>(i) / kRateHz;
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.cop_m(0, 300), 0.04 - 7 / (kMassKg * kStandardGravityMps2), 1e-6);
}

TEST(React, LeavesTheForceOfFlightAsItIs) {
  BodyCourse course = Standing();
  for (Eigen::Index i = 0; i < kFrames; ++i) {
    const double t = static_cast<double>(i) / kRateHz;
    course.com_m(2, i) = 1 + 10 * t - 0.5 * 1.02 * kStandardGravityMps2 * t * t;
  }
  const GroundReaction reaction = React(course);
  EXPECT_NEAR(reaction.force_n(2, 300), -0.02 * kMassKg * kStandardGravityMps2, 0.1);
  EXPECT_FALSE(reaction.supported[300]);
}

TEST(ShareBetweenFeet, KeepsTotalAndCop) {
  const BodyCourse course = Standing();
  GroundReaction reaction = React(course);
  reaction.cop_m.col(300) << 0.1, 0.05;
  const auto feet = ShareBetweenFeet(course, reaction, 300);
  EXPECT_NEAR(feet[0].load_n + feet[1].load_n, kMassKg * kStandardGravityMps2, 1e-6);
  const Eigen::Vector2d cop = (feet[0].load_n * feet[0].cop_m + feet[1].load_n * feet[1].cop_m) /
                              (feet[0].load_n + feet[1].load_n);
  EXPECT_NEAR((cop - Eigen::Vector2d(0.1, 0.05)).norm(), 0, 2e-3);
  EXPECT_GT(feet[0].load_n, feet[1].load_n);
}

TEST(ShareBetweenFeet, GivesNothingToARaisedFoot) {
  BodyCourse course = Standing();
  for (auto& point : course.sole_m[1]) point.row(2).setConstant(0.2);
  GroundReaction reaction = React(course);
  reaction.cop_m.col(300) << 0.05, 0.16;
  const auto feet = ShareBetweenFeet(course, reaction, 300);
  EXPECT_LT(feet[1].load_n, 1);
  EXPECT_NEAR((feet[0].cop_m - Eigen::Vector2d(0.05, 0.16)).norm(), 0, 2e-3);
}

TEST(Follow, FindsTheStandardPersonAtRestOnBothSoles) {
  const body::Skeleton skeleton = body::StandardPerson(1.75);
  body::PersonParameters person;
  const auto made = body::MakeBody(skeleton, person);
  ASSERT_TRUE(made);
  motion::Motion motion;
  motion.skeleton = skeleton;
  motion.rate_hz = 100;
  motion.q = body::TPose(skeleton, made->landmarks).replicate(1, 200);
  const BodyCourse course = Follow(*made, motion);
  const GroundReaction reaction = React(course);
  const auto feet = ShareBetweenFeet(course, reaction, 100);
  EXPECT_NEAR(feet[0].load_n, feet[1].load_n, 1e-3);
  EXPECT_NEAR(feet[0].load_n + feet[1].load_n, 75 * kStandardGravityMps2, 1e-3);
  EXPECT_GT(feet[0].cop_m.y(), 0.05);  // The left foot is on the left.
  EXPECT_LT(feet[1].cop_m.y(), -0.05);
  EXPECT_NEAR(course.com_m(2, 100), 1.0, 0.1);
}

}  // namespace
}  // namespace footing::virtual_sensors
