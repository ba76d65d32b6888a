#include "daemon/offline/eval/jump_delays.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::eval {
namespace {

struct Lasting {
  double from_s, to_s;
  bool Has(double time_s) const { return time_s >= from_s && time_s < to_s; }
};
constexpr Lasting kNever{-1, -1};
constexpr double kAnsweredWithinS = 0.5;

/// A gesture, its command and the jump, in 10 s.
JumpDelays Timed(const Lasting& meant, const Lasting& commanded, const Lasting& jumps,
                 double fall_s = -1) {
  JumpDelays delays;
  for (int i = 0; i < 1000; ++i) {
    const double time_s = 0.01 * i;
    if (i == static_cast<int>(100 * fall_s)) delays.Restart();
    delays.Add(time_s, meant.Has(time_s), commanded.Has(time_s), jumps.Has(time_s),
               kAnsweredWithinS);
  }
  return delays;
}

TEST(JumpDelays, AreTheInterfacesUpToTheCommandAndThenTheGaits) {
  const JumpDelays delays = Timed({1, 4}, {2.2, 4}, {2.7, 5});
  EXPECT_EQ(delays.to_command().count, 1u);
  EXPECT_NEAR(delays.to_command().mean_s(), 1.2, 0.011);
  EXPECT_EQ(delays.to_take_off().count, 1u);
  EXPECT_NEAR(delays.to_take_off().mean_s(), 0.5, 0.011);
}

TEST(JumpDelays, OfAShortGestureLastToTheCommandThatFollowsIt) {
  // A key is pressed and let go; the command waits for the character.
  const JumpDelays delays = Timed({1, 1.2}, {1, 2}, {1.6, 2});
  EXPECT_EQ(delays.to_command().count, 1u);
  EXPECT_NEAR(delays.to_command().mean_s(), 0, 0.011);
  EXPECT_NEAR(delays.to_take_off().mean_s(), 0.6, 0.011);
}

TEST(JumpDelays, OfAGestureThatIsOverLastToTheCommandThatIsStillItsOwn) {
  EXPECT_NEAR(Timed({1, 1.2}, {1.5, 2}, {1.8, 2}).to_command().mean_s(), 0.5, 0.011);
}

TEST(JumpDelays, OfWhatCameToNothingDoNotCount) {
  EXPECT_EQ(Timed({1, 2}, kNever, kNever).to_command().count, 0u);
  EXPECT_EQ(Timed({1, 2}, {3, 4}, {3.5, 5}).to_command().count, 0u);  // Another one's.
  EXPECT_EQ(Timed({1, 4}, {2, 3}, {3.5, 5}).to_take_off().count, 0u);
  EXPECT_EQ(Timed({1, 2}, {2.2, 3}, {2.5, 5}).to_command().count, 1u);
  EXPECT_EQ(Timed({1, 2}, {2.2, 3}, {2.5, 5}, 2).to_command().count, 0u);  // It fell.
}

TEST(JumpDelays, OfJumpsThatGoOnCountOnce) {
  const JumpDelays delays = Timed({1, 9}, {2, 9}, {2.5, 9});
  EXPECT_EQ(delays.to_command().count, 1u);
  EXPECT_EQ(delays.to_take_off().count, 1u);
}

TEST(JumpDelays, HaveTheSpreadOfWhatWasPooled) {
  JumpDelays delays = Timed({1, 4}, {2, 4}, {2.5, 5});
  delays.Pool(Timed({1, 4}, {2.4, 4}, {2.9, 5}));
  EXPECT_EQ(delays.to_command().count, 2u);
  EXPECT_NEAR(delays.to_command().mean_s(), 1.2, 0.011);
  EXPECT_NEAR(delays.to_command().sd_s(), 0.4 / std::sqrt(2.0), 0.011);
  EXPECT_NEAR(delays.to_take_off().sd_s(), 0, 0.011);
}

}  // namespace
}  // namespace footing::eval
