#include <gtest/gtest.h>

#include "common/virtual/people/person.h"
#include "daemon/offline/eval/user_devices.h"
#include "daemon/simulation/mapping/leg.h"
#include "tests/simulation/test_world.h"

/// The leg interface behind the features of synthetic users who turn by lifting one foot higher.
namespace footing::eval {
namespace {

using stream::Gait;
using stream::TurnSource;
using stream::UserInterface;

constexpr double kTurnRad = 0.0873;
/// People who lift their feet, and the outer one above the inner one, further than most.
constexpr double kAmplitude = 1.3;
/// Steps begin at once; a turn once the gait has settled.
constexpr double kTurnsS = 3, kJumpsS = 7;

/// What the interface commands a user who goes straight, then turns, then jumps.
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

}  // namespace
}  // namespace footing::eval
