#include "common/base/units.h"

#include <gtest/gtest.h>

namespace footing {
namespace {

TEST(WrapAngle, KeepsTheUpperEndAndMovesTheLowerOne) {
  EXPECT_DOUBLE_EQ(WrapAngle(kPi), kPi);
  EXPECT_DOUBLE_EQ(WrapAngle(-kPi), kPi);
}

TEST(WrapAngle, TakesWholeTurnsAway) {
  EXPECT_NEAR(WrapAngle(0.5 + 6 * kPi), 0.5, 1e-12);
  EXPECT_NEAR(WrapAngle(-0.5 - 6 * kPi), -0.5, 1e-12);
}

TEST(Units, AKilogramOnTheScaleIsStandardGravityInNewtons) {
  EXPECT_DOUBLE_EQ(KilogramsToNewtons(2.0), 19.6133);  // 2 kg * 9.80665 m/s²
  EXPECT_DOUBLE_EQ(NewtonsToKilograms(KilogramsToNewtons(3.5)), 3.5);
}

}  // namespace
}  // namespace footing
