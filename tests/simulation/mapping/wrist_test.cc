#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/noise.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/wrist.h"
#include "tests/simulation/mapping/settled.h"
#include "tests/simulation/test_world.h"

/// The wrist interface behind the features of synthetic hands, which change what they do at random.
namespace footing::mapping {
namespace {

using stream::Gait;
using wrists::Segment;

struct Change {
  double time_s = 0;
  Gait to = Gait::kStep;
};

/// Every change of the commanded gait.
std::vector<Change> ChangesOf(const std::vector<eval::Tick>& ticks) {
  WristInterface wrist(
      ParseWristMapping(test::DataFile(kWristMappingFile), kWristMappingFile).value());
  std::vector<Change> changes;
  Gait gait = Gait::kStep;
  for (const eval::Tick& tick : ticks) {
    Inputs inputs;
    TakeFeatures(tick.features, 0, inputs);
    const Gait now = wrist.Advance(tick.t_s, inputs).gait;
    if (now != gait) changes.push_back({tick.t_s, now});
    gait = now;
  }
  return changes;
}

using Draw = std::function<Segment(noise::Random&)>;

std::vector<Segment> Gestures(noise::Random& random, double duration_s, const Draw& draw) {
  std::vector<Segment> segments;
  for (double time_s = 0; time_s < duration_s; time_s += segments.back().duration_s) {
    segments.push_back(draw(random));
  }
  return segments;
}

std::vector<eval::Tick> Perform(const std::vector<Segment>& segments, double blend_s,
                                std::uint64_t seed) {
  return eval::Run(Record(wrists::HandMotion(segments, wrists::WristShape(), blend_s), {}, seed));
}

double DrawRoll(noise::Random& random) {
  return random.Uniform() < 0.5 ? 0 : DegreesToRadians(random.Uniform(-35, 35));
}

/// Rests, swings of any frequency and size, together or in turns, upright or inclined.
Segment AnyGesture(noise::Random& random) {
  const double kind = random.Uniform();
  return {.duration_s = random.Uniform(0.8, 5),
          .frequency_hz = random.Uniform(0.5, 4.5),
          .phase_rad = kind < 0.4 ? 0 : kPi,
          .amplitude_mps2 = kind < 0.15 ? 0 : random.Uniform(4, 18),
          .roll_rad = DrawRoll(random)};
}

/// The same, but never together.
Segment WalkOrRun(noise::Random& random) {
  Segment gesture = AnyGesture(random);
  gesture.duration_s = random.Uniform(1.5, 5);
  gesture.phase_rad = kPi + random.Uniform(-0.4, 0.4);
  return gesture;
}

TEST(Gestures, TwoChangesOfGaitAreNeverATenthOfASecondApart) {
  int count = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    noise::Random random(seed);
    const auto changes = ChangesOf(Perform(Gestures(random, 120, AnyGesture), 0.2, seed));
    for (std::size_t i = 1; i < changes.size(); ++i) {
      EXPECT_GT(changes[i].time_s - changes[i - 1].time_s, 0.1 - 1e-9)
          << "seed " << seed << ", at " << changes[i].time_s << " s";
    }
    count += static_cast<int>(changes.size());
  }
  EXPECT_GT(count, 80);
}

TEST(Gestures, HandsThatSwingInTurnsNeverJump) {
  for (const std::uint64_t seed : {11, 12, 13, 14}) {
    noise::Random random(seed);
    const double blend_s = seed % 2 == 0 ? 0.2 : 0.5;
    for (const Change& change :
         ChangesOf(Perform(Gestures(random, 120, WalkOrRun), blend_s, seed))) {
      EXPECT_NE(change.to, Gait::kJump) << "seed " << seed << ", at " << change.time_s << " s";
    }
  }
}

/// Between a run and a jump the features show frequencies that nobody swings.
TEST(Gestures, ARunUpKeepsItsSpeedUntilItsJumpAndASlowerRunIsFollowed) {
  WristInterface wrist(
      ParseWristMapping(test::DataFile(kWristMappingFile), kWristMappingFile).value());
  const std::vector<Segment> run_up{
      {.duration_s = 1},
      {.duration_s = 3, .frequency_hz = 3.6, .phase_rad = kPi, .amplitude_mps2 = 10},
      {.duration_s = 3, .frequency_hz = 2.6, .phase_rad = kPi, .amplitude_mps2 = 10},
      {.duration_s = 3, .frequency_hz = 3.6, .phase_rad = kPi, .amplitude_mps2 = 10},
      {.duration_s = 3, .frequency_hz = 2.2, .phase_rad = 0, .amplitude_mps2 = 12}};
  double slow_mps = 0, slowest_mps = 10;
  Gait last = Gait::kStep;
  for (const eval::Tick& tick : Perform(run_up, 0.4, 1)) {
    Inputs inputs;
    TakeFeatures(tick.features, 0, inputs);
    const auto command = wrist.Advance(tick.t_s, inputs);
    if (tick.t_s < 5.5) slow_mps = command.speed_mps;
    if (tick.t_s > 9.5 && command.gait == Gait::kRun) {
      slowest_mps = std::min(slowest_mps, command.speed_mps);
    }
    last = command.gait;
  }
  EXPECT_EQ(last, Gait::kJump);
  EXPECT_NEAR(slowest_mps, 3.42, 0.2);  // 1.5 + (3.6 - 2) / 2.5 * 3 m/s.
  EXPECT_NEAR(slow_mps, 2.22, 0.2);     // 1.5 s after the change: 2.6 Hz.
}

TEST(Gestures, AGaitIsCommandedWithinThreeCyclesOfItsStart) {
  for (const double frequency_hz : {0.6, 1.3, 3.0}) {
    for (const double phase_rad : {0.0, kPi}) {
      const Segment swing{.duration_s = 4 / frequency_hz,
                          .frequency_hz = frequency_hz,
                          .phase_rad = phase_rad,
                          .amplitude_mps2 = 8};
      const auto changes = ChangesOf(Perform({{.duration_s = 1}, swing}, 0, 1));
      ASSERT_EQ(changes.size(), 1u) << frequency_hz << " Hz, phase " << phase_rad;
      EXPECT_LT((changes[0].time_s - 1) * frequency_hz, 2.5);
      const Gait gait = phase_rad == 0 ? Gait::kJump : frequency_hz < 2 ? Gait::kWalk : Gait::kRun;
      EXPECT_EQ(changes[0].to, gait);
    }
  }
}

TEST(Gestures, HandsOfDifferentFrequencyCommandNothing) {
  const auto record = [](double frequency_hz, std::uint64_t seed) {
    const Segment swing{.duration_s = 30, .frequency_hz = frequency_hz, .amplitude_mps2 = 8};
    return Record(wrists::HandMotion({swing}, wrists::Shape(), 0), {}, seed);
  };
  auto readings = record(0.5, 1);
  const auto fast = record(4.5, 2);
  for (std::size_t i = 0; i < readings.size(); ++i) readings[i].right = fast[i].right;
  EXPECT_TRUE(ChangesOf(eval::Run(readings)).empty());
}

constexpr double kPi = std::numbers::pi;

WristMapping Mapping() {
  return ParseWristMapping(test::DataFile("wrist_mapping.json"), "wrist_mapping.json").value();
}

Inputs Swing(double frequency_hz, double phase_rad, double amplitude_mps2 = 10,
             double roll_rad = 0) {
  const LimbFeatures hand{.present = true,
                          .moving = true,
                          .frequency_valid = true,
                          .frequency_hz = frequency_hz,
                          .amplitude_valid = true,
                          .amplitude_mps2 = amplitude_mps2,
                          .inclination_valid = true,
                          .roll_rad = roll_rad};
  Inputs inputs;
  inputs.hands = {.left = hand, .right = hand, .phase_valid = true, .phase_rad = phase_rad};
  return inputs;
}

TEST(Wrist, GaitFollowsPhaseAndFrequency) {
  struct {
    double frequency_hz, phase_rad;
    Gait gait;
    double speed_mps;
  } const rows[] = {{0.5, kPi, Gait::kWalk, 0.2},   // Ends and middles of the committed ranges.
                    {1.25, kPi, Gait::kWalk, 0.8},  // 0.2 + (1.25 - 0.5) / 1.5 * 1.2
                    {1.9, -3.0, Gait::kWalk, 1.32}, {2.1, kPi, Gait::kRun, 1.62},
                    {3.25, 2.5, Gait::kRun, 3.0},   {9.0, kPi, Gait::kRun, 4.5},
                    {1.75, 0.2, Gait::kJump, 0.75}, {1.75, -0.9, Gait::kJump, 0.75}};
  for (const auto& row : rows) {
    WristInterface wrist(Mapping());
    const auto command = Settled(wrist, 0, Swing(row.frequency_hz, row.phase_rad));
    EXPECT_EQ(command.gait, row.gait) << row.frequency_hz << " Hz, phase " << row.phase_rad;
    EXPECT_NEAR(command.speed_mps, row.speed_mps, 1e-9) << row.frequency_hz;
  }
}

TEST(Wrist, AfterAPutBackTheHandsHaveToShowTheirGaitAgain) {
  WristInterface wrist(Mapping());
  EXPECT_EQ(Settled(wrist, 0, Swing(2, 0)).gait, Gait::kJump);
  wrist.StartAgain();
  Inputs unknown = Swing(2, 0);
  unknown.hands.phase_valid = false;  // As while they go over to another motion.
  EXPECT_EQ(wrist.Advance(20, unknown).gait, Gait::kStep);
  EXPECT_EQ(Settled(wrist, 20, Swing(2, 0)).gait, Gait::kJump);
}

/// Bent arms hang down again: they do not run any more, whether or not they swing together.
TEST(SwingGait, WhatContradictsTheGaitCountsWhileThePhaseIsNotKnown) {
  const auto walks_after_s = [](double unknown_s) {
    SwingGait gait(Mapping().swing);
    Inputs inputs = Swing(1, kPi);
    double time_s = 0;
    for (; time_s < 3; time_s += 0.01) gait.Advance(time_s, inputs.hands, true);
    EXPECT_EQ(gait.gait(), Gait::kRun);
    inputs.hands.phase_valid = false;
    const double from_s = time_s;
    for (; time_s < from_s + unknown_s; time_s += 0.01) gait.Advance(time_s, inputs.hands, false);
    inputs.hands.phase_valid = true;
    const double known_s = time_s;
    while (gait.gait() == Gait::kRun) gait.Advance(time_s += 0.01, inputs.hands, false);
    return time_s - known_s;
  };
  EXPECT_NEAR(walks_after_s(0), 0.75, 0.03);  // change_cycles of 1 Hz.
  EXPECT_NEAR(walks_after_s(0.3), 0.45, 0.03);
  EXPECT_NEAR(walks_after_s(1), 0.25, 0.03);  // start_cycles.
}

/// Hands that change over are together before they show their new period.
TEST(SwingGait, AJumpBeginsWithTheLastFrequencyAndAmplitude) {
  SwingGait gait(Mapping().swing);
  double time_s = 0;
  const auto lasts = [&](const Inputs& inputs, bool run) {
    biped::GaitCommand command;
    for (const double until_s = time_s + 2; time_s < until_s; time_s += 0.01) {
      command = gait.Advance(time_s, inputs.hands, run);
    }
    return command;
  };
  EXPECT_EQ(lasts(Swing(2.5, kPi, 14.5), true).gait, Gait::kRun);
  Inputs together = Swing(0, 0, 0);
  for (LimbFeatures* hand : {&together.hands.left, &together.hands.right}) {
    hand->frequency_valid = hand->amplitude_valid = false;
  }
  const auto jump = lasts(together, false);
  EXPECT_EQ(jump.gait, Gait::kJump);
  EXPECT_NEAR(jump.speed_mps, 1.2, 1e-9);   // (2.5 - 0.5) / 2.5 * 1.5
  EXPECT_NEAR(jump.height_m, 0.215, 1e-9);  // Middle of both, as of AmplitudeSetsTheHeightOfAJump.
  EXPECT_NEAR(lasts(Swing(1.75, 0, 4), false).speed_mps, 0.75, 1e-9);
}

/// Hands that incline to turn, and come back, swing together for as long as that takes.
TEST(Wrist, RestingHandsThatTurnAndTurnBackDoNotJump) {
  constexpr double kTurnS = 0.5, kFrequencyHz = 1.16;
  WristInterface wrist(Mapping());
  Inputs rest = Swing(1, kPi);
  rest.hands.left.moving = rest.hands.right.moving = false;
  double time_s = 0;
  const auto lasts = [&wrist, &time_s](const Inputs& inputs, double until_s, Gait gait) {
    for (; time_s < until_s; time_s += 0.01) EXPECT_EQ(wrist.Advance(time_s, inputs).gait, gait);
  };
  lasts(rest, 1, Gait::kStep);
  lasts(Swing(kFrequencyHz, 0), 1 + kTurnS, Gait::kStep);
  lasts(rest, 2, Gait::kStep);
  // Who means a jump goes on.
  EXPECT_EQ(Settled(wrist, 2, Swing(kFrequencyHz, 0)).gait, Gait::kJump);
}

TEST(Wrist, AmplitudeSetsTheHeightOfAJump) {
  WristInterface wrist(Mapping());
  EXPECT_NEAR(Settled(wrist, 0, Swing(2, 0, 4)).height_m, 0.08, 1e-9);
  EXPECT_NEAR(Settled(wrist, 2, Swing(2, 0, 14.5)).height_m, 0.215, 1e-9);  // Middle of both.
  EXPECT_NEAR(Settled(wrist, 4, Swing(2, 0, 60)).height_m, 0.35, 1e-9);
}

TEST(Wrist, RestingHandsStepInPlace) {
  WristInterface wrist(Mapping());
  EXPECT_EQ(Settled(wrist, 0, Swing(1, kPi)).gait, Gait::kWalk);
  Inputs rest = Swing(1, kPi);
  rest.hands.left.moving = rest.hands.right.moving = false;
  EXPECT_EQ(Settled(wrist, 2, rest).gait, Gait::kStep);
  EXPECT_EQ(Settled(wrist, 4, Swing(1, kPi)).gait, Gait::kWalk);
  Inputs one = Swing(1, kPi);
  one.hands.left = {};
  EXPECT_EQ(wrist.Advance(6, one).gait, Gait::kStep);
}

TEST(Wrist, BordersHaveHysteresis) {
  WristInterface wrist(Mapping());
  EXPECT_EQ(Settled(wrist, 0, Swing(1.95, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(Settled(wrist, 2, Swing(2.05, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(Settled(wrist, 4, Swing(2.10, kPi)).gait, Gait::kRun);
  EXPECT_EQ(Settled(wrist, 6, Swing(1.95, kPi)).gait, Gait::kRun);
  EXPECT_EQ(Settled(wrist, 8, Swing(1.90, kPi)).gait, Gait::kWalk);
  EXPECT_EQ(Settled(wrist, 10, Swing(1.5, kPi / 2)).gait, Gait::kWalk);
  EXPECT_EQ(Settled(wrist, 12, Swing(1.5, 1.2)).gait, Gait::kJump);
  EXPECT_EQ(Settled(wrist, 14, Swing(1.5, -kPi / 2)).gait, Gait::kJump);
  EXPECT_EQ(Settled(wrist, 16, Swing(1.5, -1.9)).gait, Gait::kWalk);
}

TEST(Wrist, LeaningTurnsTowardsTheLowerSide) {
  WristInterface wrist(Mapping());
  const double step_rad = 5 * kPi / 180;  // Paper: constant increment of 5 degrees.
  EXPECT_EQ(wrist.Advance(0, Swing(1, kPi, 10, 0.3)).turn_per_step_rad, 0);
  // Left side higher: lean to the right, turn to the right, which is negative.
  EXPECT_NEAR(wrist.Advance(1, Swing(1, kPi, 10, 0.5)).turn_per_step_rad, -step_rad, 1e-12);
  EXPECT_NEAR(wrist.Advance(2, Swing(1, kPi, 10, 0.3)).turn_per_step_rad, -step_rad, 1e-12);
  EXPECT_EQ(wrist.Advance(3, Swing(1, kPi, 10, 0.2)).turn_per_step_rad, 0);
  EXPECT_NEAR(wrist.Advance(4, Swing(1, kPi, 10, -0.5)).turn_per_step_rad, step_rad, 1e-12);
}

TEST(Wrist, FeaturesNotYetValidHoldTheGaitForAWhile) {
  WristInterface wrist(Mapping());
  Settled(wrist, 0, Swing(3, kPi));
  Inputs unsure = Swing(3, kPi);
  unsure.hands.phase_valid = false;
  EXPECT_EQ(wrist.Advance(2, unsure).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(4.9, unsure).gait, Gait::kRun);
  EXPECT_EQ(wrist.Advance(5.1, unsure).gait, Gait::kStep);  // hold_s is 3.
  WristInterface fresh(Mapping());
  EXPECT_EQ(fresh.Advance(0, unsure).gait, Gait::kStep);
}

TEST(Wrist, TheTurnFollowsTheHandsWhileTheirPhaseIsNotKnown) {
  WristInterface wrist(Mapping());
  EXPECT_LT(Settled(wrist, 0, Swing(1, kPi, 10, 0.5)).turn_per_step_rad, 0);
  Inputs unsure = Swing(1, kPi, 10, 0);
  unsure.hands.phase_valid = false;
  EXPECT_EQ(wrist.Advance(2, unsure).turn_per_step_rad, 0);
}

TEST(Wrist, WithoutItsControllersTheCharacterStopsAndTurnsNoMore) {
  WristInterface wrist(Mapping());
  Settled(wrist, 0, Swing(1, kPi, 10, 0.5));
  // As footingd reports controllers that it has not heard of for half a second.
  stream::RigFeatures rig;
  rig.devices.resize(2);
  rig.devices[0].role = stream::DeviceRole::kLeftHand;
  rig.devices[1].role = stream::DeviceRole::kRightHand;
  Inputs gone;
  TakeFeatures(rig, 0, gone);
  const auto command = wrist.Advance(2, gone);
  EXPECT_EQ(command.gait, Gait::kStep);
  EXPECT_EQ(command.turn_per_step_rad, 0);
  EXPECT_EQ(wrist.state().activity, stream::Activity::kAbsent);
  EXPECT_EQ(wrist.state().missing_roles, stream::RoleBit(stream::DeviceRole::kLeftHand) |
                                             stream::RoleBit(stream::DeviceRole::kRightHand));
}

TEST(Inputs, HandsAreTakenWithThePairTheyForm) {
  stream::RigFeatures rig;
  rig.devices.resize(3);
  rig.devices[0].device = 7;
  rig.devices[0].role = stream::DeviceRole::kRightHand;
  rig.devices[0].frequency_valid = true;
  rig.devices[0].frequency_hz = std::numeric_limits<double>::quiet_NaN();
  rig.devices[1].device = 9;
  rig.devices[1].role = stream::DeviceRole::kHead;
  rig.devices[2].device = 4;
  rig.devices[2].role = stream::DeviceRole::kLeftHand;
  rig.devices[2].moving = true;
  rig.pairs = {{9, 7, true, 2.0}, {7, 4, true, 0.5}};
  Inputs inputs;
  TakeFeatures(rig, stream::RoleBit(stream::DeviceRole::kLeftHand), inputs);
  EXPECT_TRUE(inputs.hands.left.present && inputs.hands.left.moving);
  EXPECT_TRUE(inputs.hands.left.mounted);
  EXPECT_FALSE(inputs.hands.right.frequency_valid || inputs.hands.right.mounted);
  EXPECT_TRUE(inputs.hands.phase_valid);
  EXPECT_EQ(inputs.hands.phase_rad, -0.5);  // That pair was given the other way round.
}

TEST(WristMapping, RefusesRangesThatDoNotRise) {
  std::string text = test::DataFile("wrist_mapping.json");
  const std::string key = "\"walk_frequency_max_hz\": 2.0";
  text.replace(text.find(key), key.size(), "\"walk_frequency_max_hz\": 0.4");
  EXPECT_FALSE(ParseWristMapping(text, "wrist_mapping.json").ok());
}

}  // namespace
}  // namespace footing::mapping
