#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/virtual/people/person.h"
#include "daemon/offline/eval/track_trial.h"
#include "daemon/simulation/mapping/any_interface.h"
#include "tests/simulation/test_world.h"

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
  EXPECT_EQ(events.not_meant(), 0u);
}

TEST(JumpEvents, PoolAddsUp) {
  JumpEvents events = Told({{{1, 1.2}}, {{1.5, 2}}});
  events.Pool(Told({{{1, 1.2}}, {{4, 4.1}}}));
  EXPECT_EQ(events.recall(), 0.5);
  EXPECT_EQ(events.commanded(), 2u);
  EXPECT_EQ(events.not_meant(), 1u);
}

}  // namespace

/// The leg interface behind the features of synthetic users who turn by lifting one foot higher.
namespace {

using stream::Gait;
using stream::TurnSource;
using stream::UserInterface;

constexpr double kTurnRad = 0.0873;
/// People who lift their feet, and the outer one above the inner one, further than most.
constexpr double kAmplitude = 1.3;
/// Steps begin at once; a turn once the gait has settled.
constexpr double kTurnsS = 3, kJumpsS = 7;

/// Commands of the interface for a user who goes straight, then turns, then jumps.
struct Commanded {
  double jump_s = 0;   ///< Time of a jump before the user jumps.
  double other_s = 0;  ///< Time of another gait than the user's, from the begin of the turn on.
  double jump_after_s = INFINITY;  ///< From the user's jump to its command.
};

Commanded Follow(Gait gait, double effort, double turn_rad, std::uint64_t seed) {
  const auto mapping =
      mapping::ParseLegMapping(test::DataFile(mapping::kLegMappingFile), mapping::kLegMappingFile);
  mapping::LegInterface leg(mapping.value(), {.turn_by = TurnSource::kFeet});
  users::Style style = users::DrawStyle(seed, UserInterface::kLeg);
  style.amplitude = kAmplitude;
  users::Person person(UserInterface::kLeg, style, seed, TurnSource::kFeet);
  UserDevices devices(UserInterface::kLeg, TurnSource::kFeet, seed);
  Commanded commanded;
  for (int i = 1; i * UserDevices::kTickS < kJumpsS + 2.5; ++i) {
    const double time_s = i * UserDevices::kTickS;
    const bool jumps = time_s > kJumpsS, turns = time_s > kTurnsS && !jumps;
    person.Advance(
        time_s,
        {.gait = jumps ? Gait::kJump : gait, .turn_rad = turns ? turn_rad : 0, .effort = effort});
    const auto command = leg.Advance(time_s, devices.Take(person.felt()));
    if (jumps && command.gait == Gait::kJump) {
      commanded.jump_after_s = std::min(commanded.jump_after_s, time_s - kJumpsS);
    }
    if (!turns) continue;
    if (command.gait == Gait::kJump) commanded.jump_s += UserDevices::kTickS;
    if (command.gait != gait) commanded.other_s += UserDevices::kTickS;
  }
  return commanded;
}

class TurnByFeet : public testing::TestWithParam<std::pair<Gait, double>> {};

TEST_P(TurnByFeet, GoesOnInItsGaitAndIsNoJump) {
  const auto [gait, effort] = GetParam();
  for (const std::uint64_t seed : {1, 2}) {
    for (const double turn_rad : {-kTurnRad, kTurnRad}) {
      const Commanded commanded = Follow(gait, effort, turn_rad, seed);
      EXPECT_EQ(commanded.jump_s, 0) << seed << ", " << turn_rad;
      EXPECT_LT(commanded.other_s, 0.5) << seed << ", " << turn_rad;
    }
  }
}

TEST_P(TurnByFeet, DoesNotKeepAJumpFromBeingSeen) {
  const auto [gait, effort] = GetParam();
  for (const std::uint64_t seed : {1, 2}) {
    const double straight_s = Follow(gait, effort, 0, seed).jump_after_s;
    EXPECT_LT(Follow(gait, effort, kTurnRad, seed).jump_after_s, straight_s + 0.5) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Gaits, TurnByFeet,
                         testing::Values(std::pair{Gait::kWalk, 0.5}, std::pair{Gait::kWalk, 1.0},
                                         std::pair{Gait::kRun, 0.0}, std::pair{Gait::kRun, 0.5},
                                         std::pair{Gait::kRun, 1.0}));

constexpr auto kArm = stream::UserInterface::kArm;
constexpr double kChangeS = 3, kEndS = 9;
/// 0.4 s in which the arms change over, and 1.9 cycles of 1.1 Hz (docs/interfaces.md).
constexpr double kFollowsS = 2.2;

/// How long a hand of somebody who turns while walking, then running faster and faster, shows
/// another tempo than that of the arms, once the change is over, s.
double WrongTempoS(std::uint64_t seed) {
  users::Person person(kArm, users::DrawStyle(seed, kArm), seed);
  UserDevices devices(kArm, stream::TurnSource::kUnspecified, seed);
  double wrong_s = 0;
  for (int i = 1; i * UserDevices::kTickS < kEndS; ++i) {
    const double t_s = i * UserDevices::kTickS;
    const bool runs = t_s > kChangeS;
    person.Advance(t_s, {.gait = runs ? Gait::kRun : Gait::kWalk,
                         .turn_rad = std::fmod(t_s, 1.2) < 0.5 ? 0.0873 : 0,
                         .effort = runs ? (t_s - kChangeS) / (kEndS - kChangeS) : 0.8});
    const mapping::Inputs inputs = devices.Take(person.felt());
    const auto wrong = [&person](const mapping::LimbFeatures& hand) {
      return !hand.frequency_valid || std::fabs(hand.frequency_hz / person.limb_hz() - 1) > 0.25;
    };
    const bool over = t_s > kChangeS + kFollowsS;
    if (over && (wrong(inputs.hands.left) || wrong(inputs.hands.right))) {
      wrong_s += UserDevices::kTickS;
    }
  }
  return wrong_s;
}

/// These, of 120 users, are the ones of whom one hand showed half its tempo to the end.
TEST(UserTempo, OfArmsThatBeginToRunInATurnIsThatOfBothHands) {
  for (const std::uint64_t seed : {39, 75, 100}) EXPECT_LT(WrongTempoS(seed), 0.1) << seed;
}

}  // namespace
}  // namespace footing::eval
