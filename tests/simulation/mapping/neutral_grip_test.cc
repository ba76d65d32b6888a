#include "daemon/simulation/mapping/neutral_grip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::mapping {
namespace {

/// The same rotation every 10 ms, for `seconds` from `from_s`.
void Go(NeutralGrip& grip, double from_s, double seconds, double rotation_deg) {
  for (int i = 0; i < 100 * seconds; ++i) {
    grip.Stride(from_s + 0.01 * i, DegreesToRadians(rotation_deg), 0.8);
  }
}

double TwistDegrees(const NeutralGrip& grip, double rotation_deg) {
  return RadiansToDegrees(grip.TwistOf(DegreesToRadians(rotation_deg)).value());
}

TEST(NeutralGrip, WithoutARestItIsTheMeanOfTheFirstCycleAndNotKnownBefore) {
  NeutralGrip grip;
  Go(grip, 0, 1.2, 45);  // A cycle at 0.8 Hz takes 1.25 s.
  EXPECT_FALSE(grip.known());
  EXPECT_FALSE(grip.TwistOf(0));
  Go(grip, 1.2, 0.1, 45);
  ASSERT_TRUE(grip.known());
  EXPECT_NEAR(TwistDegrees(grip, 80), 35, 1e-9);
}

TEST(NeutralGrip, StridesThatWereTooFewDoNotCount) {
  NeutralGrip grip;
  Go(grip, 0, 1, -45);
  grip.Rest();
  Go(grip, 2, 1, 45);
  EXPECT_FALSE(grip.known());
  Go(grip, 3, 0.5, 45);
  EXPECT_NEAR(TwistDegrees(grip, 45), 0, 1e-9);
  grip.Rest();
  EXPECT_TRUE(grip.known());
}

TEST(NeutralGrip, ATwistNeverBecomesTheNeutralHoweverLongItLasts) {
  NeutralGrip grip;
  Go(grip, 0, 3, 10);
  Go(grip, 3, 120, 35);
  EXPECT_NEAR(TwistDegrees(grip, 35), 25, 1e-9);
}

TEST(NeutralGrip, FollowsAGripThatSlips) {
  NeutralGrip grip;
  for (int second = 0; second < 300; ++second) Go(grip, second, 1, 0.1 * second);
  EXPECT_LT(std::fabs(TwistDegrees(grip, 30)), 5);  // 0.1 degrees a second, with a lag of 30 s.
}

/// Arms that hang still at the same rotation, every 10 ms.
void Hang(NeutralGrip& grip, double from_s, double seconds, double rotation_deg) {
  for (int i = 0; i < 100 * seconds; ++i) {
    grip.Hang(from_s + 0.01 * i, DegreesToRadians(rotation_deg));
  }
}

TEST(NeutralGrip, ArmsThatHungStillShowItBeforeTheFirstStrideWhichMayTurn) {
  NeutralGrip grip;
  Hang(grip, 0, 0.6, 30);
  Go(grip, 0.7, 5, 66);  // A twist of 36 degrees from the first stride on.
  EXPECT_NEAR(TwistDegrees(grip, 66), 36, 1e-9);
}

TEST(NeutralGrip, TheLastMomentOfARestIsAMotionThatBegins) {
  NeutralGrip grip;
  Hang(grip, 0, 0.6, 30);
  Hang(grip, 0.6, 0.19, 45);
  Go(grip, 0.79, 1, 66);
  EXPECT_NEAR(TwistDegrees(grip, 66), 36, 1e-9);
}

TEST(NeutralGrip, IsRenewedByTheRestThatGoesOnElseByWhatComes) {
  NeutralGrip grip;
  Hang(grip, 0, 1, 10);
  Go(grip, 1, 3, 10);
  Hang(grip, 4, 1, 40);
  EXPECT_NEAR(TwistDegrees(grip, 40), 30, 1e-9);
  grip.Renew();
  EXPECT_NEAR(TwistDegrees(grip, 40), 0, 1e-9);
  Go(grip, 5, 3, 40);
  grip.Renew();
  EXPECT_FALSE(grip.known());
  Go(grip, 8, 2, -20);
  EXPECT_NEAR(TwistDegrees(grip, -20), 0, 1e-9);
}

TEST(NeutralGrip, LaterRestsDoNotCount) {
  NeutralGrip grip;
  Hang(grip, 0, 1, 10);
  Go(grip, 1, 3, 10);
  Hang(grip, 4, 3, 46);
  EXPECT_NEAR(TwistDegrees(grip, 46), 36, 1e-9);
}

}  // namespace
}  // namespace footing::mapping
