#include "daemon/offline/analysis/tracking.h"

#include <gtest/gtest.h>

namespace footing::tracking {
namespace {

constexpr GivenCommand kRunAtTwo{.time_s = 10, .speed_mps = 2, .falls_before = 1};

stream::GaitState Running(bool pending = false, std::uint64_t falls = 1) {
  stream::GaitState state;
  state.gait = stream::Gait::kRun;
  state.pending = pending;
  state.falls = falls;
  return state;
}

TEST(Tracking, AShortCommandIsNotJudgedHoweverItWent) {
  EXPECT_EQ(CheckTracking(kRunAtTwo, 12.999, Running(), 2), Tracking::kShort);
  EXPECT_EQ(CheckTracking(kRunAtTwo, 12.999, Running(true, 5), 9), Tracking::kShort);
  EXPECT_EQ(CheckTracking(kRunAtTwo, 13, Running(), 2), Tracking::kTracked);
}

TEST(Tracking, TheSpeedMustBeKeptToAQuarterOfAMetreASecond) {
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(), 2.24), Tracking::kTracked);
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(), 1.76), Tracking::kTracked);
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(), 2.26), Tracking::kOffSpeed);
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(), 1.74), Tracking::kOffSpeed);
}

TEST(Tracking, AnotherGaitAtTheRightSpeedIsNotWhatWasTold) {
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(true), 2), Tracking::kOtherGait);
}

TEST(Tracking, AFallIsNotMadeGoodByTheRightSpeedAfterIt) {
  EXPECT_EQ(CheckTracking(kRunAtTwo, 14, Running(false, 2), 2), Tracking::kFell);
}

TEST(Tracking, AFallBeforeTheCommandDoesNotCount) {
  GivenCommand given = kRunAtTwo;
  given.falls_before = 7;
  EXPECT_EQ(CheckTracking(given, 14, Running(false, 7), 2), Tracking::kTracked);
}

TEST(SpeedOverAStep, IsTheMeanOfTheLastHalfSecond) {
  SpeedOverAStep speed;
  for (int i = 0; i < 3000; ++i) speed.Add(9);  // Forgotten.
  for (int i = 0; i < 500; ++i) speed.Add(i < 250 ? 1.6 : 2.4);
  EXPECT_NEAR(speed.mean_mps(), 2, 1e-12);
  for (int i = 0; i < 250; ++i) speed.Add(2.4);
  EXPECT_NEAR(speed.mean_mps(), 2.4, 1e-12);
}

}  // namespace
}  // namespace footing::tracking
