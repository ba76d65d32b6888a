#include "common/virtual/people/person.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::users {
namespace {

using stream::Gait;
using stream::UserInterface;

constexpr UserInterface kWithRemotes[] = {UserInterface::kWrist, UserInterface::kArm,
                                          UserInterface::kLeg};

/// A user whose motions are exactly ordinary ones.
Style Ordinary() {
  Style style;
  style.tempo_drift = 0;
  return style;
}

/// Readings every 10 ms, from `from_s` for `duration_s`, at a constant intention.
std::vector<Felt> Perform(Person& person, const Intention& wanted, double from_s,
                          double duration_s) {
  std::vector<Felt> felt;
  for (double t_s = from_s; t_s < from_s + duration_s; t_s += 0.01) {
    person.Advance(t_s, wanted);
    felt.push_back(person.felt());
  }
  return felt;
}

TEST(Person, AtRestEveryRemoteFeelsGravityAlone) {
  for (const UserInterface interface : kWithRemotes) {
    Person person(interface, Ordinary(), 1);
    const Felt felt = Perform(person, {}, 0, 2).back();
    ASSERT_EQ(felt.remote_count, interface == UserInterface::kLeg ? 3 : 2);
    for (int i = 0; i < felt.remote_count; ++i) {
      EXPECT_NEAR(felt.remotes[static_cast<std::size_t>(i)].specific_force_S_mps2.norm(),
                  kStandardGravityMps2, 1e-6)
          << stream::Name(interface) << i;
    }
  }
}

TEST(Person, AHangingArmPointsDownAndABentOneForwards) {
  Person person(UserInterface::kArm, Ordinary(), 1);
  // The front of a hanging remote points down: it feels -g there, less 12 + 6 degrees.
  EXPECT_LT(Perform(person, {}, 0, 1).back().remotes[0].specific_force_S_mps2.y(), -9);
  const auto bent = Perform(person, {.gait = Gait::kRun}, 1, 4);
  double mean_mps2 = 0;
  for (std::size_t i = 100; i < bent.size(); ++i) {
    mean_mps2 += bent[i].remotes[0].specific_force_S_mps2.y() / static_cast<double>(bent.size());
  }
  EXPECT_GT(mean_mps2, -4);
}

TEST(Person, AGripOf45DegreesTurnsWhatTheRemoteFeelsAboutItsFront) {
  Style rotated = Ordinary();
  rotated.left_grip_rad = DegreesToRadians(45);
  Person straight(UserInterface::kWrist, Ordinary(), 1), turned(UserInterface::kWrist, rotated, 1);
  const auto a = Perform(straight, {.gait = Gait::kWalk}, 0, 3);
  const auto b = Perform(turned, {.gait = Gait::kWalk}, 0, 3);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Eigen::Vector3d &level = a[i].remotes[0].specific_force_S_mps2,
                          &held = b[i].remotes[0].specific_force_S_mps2;
    EXPECT_NEAR(level.y(), held.y(), 1e-9);
    EXPECT_NEAR(level.norm(), held.norm(), 1e-9);
    EXPECT_NEAR(held.x(), -level.z() * std::sin(DegreesToRadians(45)), 1e-9);
  }
}

/// Half the peak to peak of what a shin feels along itself over the last 4 s.
double ShinAmplitude(const std::vector<Felt>& felt, std::size_t leg) {
  double least = 1e9, most = -1e9;
  for (std::size_t i = felt.size() - 400; i < felt.size(); ++i) {
    least = std::min(least, felt[i].remotes[leg].specific_force_S_mps2.z());
    most = std::max(most, felt[i].remotes[leg].specific_force_S_mps2.z());
  }
  return (most - least) / 2;
}

TEST(Person, WhoTurnsByTheFeetLiftsTheOuterOneHigherButNotFasterThanAnEvenStep) {
  Person straight(UserInterface::kLeg, Ordinary(), 1, stream::TurnSource::kFeet);
  const auto even = Perform(straight, {.gait = Gait::kWalk}, 0, 8);
  const double even_mps2 = ShinAmplitude(even, 0);
  EXPECT_NEAR(even_mps2 / ShinAmplitude(even, 1), 1, 0.1);
  for (const double turn_rad : {-0.087, 0.087}) {
    Person person(UserInterface::kLeg, Ordinary(), 1, stream::TurnSource::kFeet);
    const auto felt = Perform(person, {.gait = Gait::kWalk, .turn_rad = turn_rad}, 0, 8);
    ASSERT_EQ(felt.back().remote_count, 2);  // Nothing on the head.
    const double left = ShinAmplitude(felt, 0), right = ShinAmplitude(felt, 1);
    EXPECT_GT(turn_rad < 0 ? left - right : right - left, 0.2 * (left + right)) << turn_rad;
    EXPECT_NEAR(std::max(left, right), even_mps2, 0.1 * even_mps2) << turn_rad;
  }
}

TEST(Person, WhoTurnsByTheTrunkInclinesItAndLoadsTheLegOnThatSide) {
  Person person(UserInterface::kLeg, Ordinary(), 1, stream::TurnSource::kTrunk);
  const Felt standing = Perform(person, {.turn_rad = -0.087}, 0, 2).back();
  ASSERT_EQ(standing.remote_count, 3);
  EXPECT_EQ(standing.remotes[2].role, stream::DeviceRole::kTrunk);
  // Left side up by 22 degrees.
  EXPECT_NEAR(standing.remotes[2].specific_force_S_mps2.x(),
              kStandardGravityMps2 * std::sin(DegreesToRadians(22)), 0.01);
  const auto felt = Perform(person, {.gait = Gait::kWalk, .turn_rad = -0.087}, 2, 8);
  EXPECT_GT(ShinAmplitude(felt, 0), 1.1 * ShinAmplitude(felt, 1));
}

TEST(Person, BothBoardsTogetherBearTheWeightOnAverage) {
  Style style = Ordinary();
  style.mass_kg = 80;
  for (const Gait gait : {Gait::kStep, Gait::kWalk, Gait::kRun}) {
    Person person(UserInterface::kBoards, style, 1);
    const auto felt = Perform(person, {.gait = gait, .effort = 0.5}, 0, 30);
    double sum_n = 0;
    for (const Felt& now : felt) sum_n += now.feet[0].load_n + now.feet[1].load_n;
    EXPECT_NEAR(sum_n / static_cast<double>(felt.size()), KilogramsToNewtons(80), 8);
  }
}

TEST(Person, WhoLeansStandsForLongerOnThatFoot) {
  Person person(UserInterface::kBoards, Ordinary(), 1);
  const auto felt = Perform(person, {.gait = Gait::kWalk, .turn_rad = -0.087}, 0, 20);
  double right_n = 0, both_n = 0;
  for (const Felt& now : felt) {
    right_n += now.feet[1].load_n;
    both_n += now.feet[0].load_n + now.feet[1].load_n;
  }
  // The COM leans by 5 cm of half a stance of 16.8 cm: 0.5 (1 + 0.30).
  EXPECT_NEAR(right_n / both_n, 0.65, 0.03);
}

TEST(Person, AHeelRiseBeginsWithBothFeetDownAndPushesMoreThanTheWeight) {
  Person person(UserInterface::kBoards, Ordinary(), 1);
  Perform(person, {.gait = Gait::kWalk}, 0, 5);
  double most_n = 0, forward_m = 0;
  for (const Felt& now : Perform(person, {.gait = Gait::kJump}, 5, 1.1)) {
    const double load_n = now.feet[0].load_n + now.feet[1].load_n;
    if (now.feet[0].cop_m.x() > 0.05) {
      EXPECT_NEAR(now.feet[0].load_n / load_n, 0.5, 0.1);
      most_n = std::max(most_n, load_n);
    }
    forward_m = std::max(forward_m, now.feet[0].cop_m.x());
  }
  EXPECT_GT(forward_m, 0.06);
  EXPECT_GT(most_n, 1.2 * KilogramsToNewtons(70));
  EXPECT_LT(most_n, 2 * KilogramsToNewtons(70));
}

TEST(Person, APressIsShortAndTheStickStaysOnItsRim) {
  Person person(UserInterface::kJoystick, Ordinary(), 1);
  Perform(person, {.gait = Gait::kRun, .effort = 1}, 0, 2);
  int pressed = 0;
  for (const Felt& now : Perform(person, {.gait = Gait::kJump}, 2, 2)) {
    pressed += now.button_a ? 1 : 0;
    EXPECT_LE(std::hypot(now.stick_x, now.stick_y), 1 + 1e-9);
  }
  EXPECT_NEAR(pressed, 12, 2);  // 0.12 s.
}

}  // namespace
}  // namespace footing::users
