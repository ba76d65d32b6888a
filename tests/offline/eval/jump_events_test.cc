#include "daemon/offline/eval/jump_events.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::eval {
namespace {

constexpr double kDelayS = 1;

/// Times of gestures, of commands and of falls, s.
struct Span {
  double from_s, to_s;
};
struct Story {
  std::vector<Span> meant, commanded;
  double fall_s = -1;
};

bool Within(const std::vector<Span>& spans, double time_s) {
  for (const Span& span : spans) {
    if (time_s >= span.from_s && time_s < span.to_s) return true;
  }
  return false;
}

JumpEvents Told(const Story& story) {
  JumpEvents events;
  for (int i = 0; i < 1000; ++i) {
    const double time_s = 0.01 * i;
    if (i == static_cast<int>(100 * story.fall_s)) events.Restart();
    events.Add(time_s, Within(story.meant, time_s), Within(story.commanded, time_s), kDelayS);
  }
  return events;
}

TEST(JumpEvents, AShortGestureThatIsAnsweredWithinTheDelayIsRecognised) {
  const JumpEvents events = Told({{{1, 1.2}}, {{1.9, 2.5}}});
  EXPECT_EQ(events.meant(), 1u);
  EXPECT_EQ(events.recognised(), 1u);
  EXPECT_EQ(events.late(), 0u);
  EXPECT_EQ(events.commanded(), 1u);
  EXPECT_EQ(events.not_meant(), 0u);
}

TEST(JumpEvents, ALongOneThatIsAnsweredAfterTheDelayIsLate) {
  const JumpEvents events = Told({{{1, 4}}, {{2.5, 5}}});
  EXPECT_EQ(events.recognised(), 1u);
  EXPECT_EQ(events.late(), 1u);
  EXPECT_EQ(events.not_meant(), 0u);
}

TEST(JumpEvents, OneThatIsNotAnsweredIsMissedHoweverShortOrLong) {
  for (const double until_s : {1.1, 6.0}) {
    const JumpEvents events = Told({{{1, until_s}}, {}});
    EXPECT_EQ(events.meant(), 1u);
    EXPECT_EQ(events.recognised(), 0u);
    EXPECT_EQ(events.recall(), 0);
  }
}

TEST(JumpEvents, ACommandThatNobodyMeantIsFalse) {
  const JumpEvents events = Told({{{1, 1.3}}, {{1.5, 2}, {4, 4.1}}});
  EXPECT_EQ(events.commanded(), 2u);
  EXPECT_EQ(events.not_meant(), 1u);
  EXPECT_EQ(events.false_share(), 0.5);
  EXPECT_EQ(events.recall(), 1);
}

TEST(JumpEvents, OneCommandDoesNotAnswerTwoGestures) {
  const JumpEvents events = Told({{{1, 1.2}, {1.5, 1.7}}, {{1.8, 1.9}}});
  EXPECT_EQ(events.meant(), 2u);
  EXPECT_EQ(events.recognised(), 1u);
}

TEST(JumpEvents, AGestureThatAFallCutsShortDoesNotCountUnlessItsDelayWasOver) {
  EXPECT_EQ(Told({{{1, 6}}, {}, 2.5}).meant(), 2u);  // The missed one, and what is left of it.
  const JumpEvents events = Told({{{1, 1.2}}, {}, 1.5});
  EXPECT_EQ(events.meant(), 0u);
  EXPECT_EQ(events.recall(), 1);
  EXPECT_EQ(events.false_share(), 0);
}

TEST(JumpEvents, PoolAddsUp) {
  JumpEvents events = Told({{{1, 1.2}}, {{1.5, 2}}});
  events.Pool(Told({{{1, 1.2}}, {{4, 4.1}}}));
  EXPECT_EQ(events.recall(), 0.5);
  EXPECT_EQ(events.false_share(), 0.5);
}

}  // namespace
}  // namespace footing::eval
