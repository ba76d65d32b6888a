#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "common/base/units.h"
#include "common/virtual/devices/random.h"
#include "common/virtual/devices/hand_motion.h"
#include "daemon/offline/analysis/features_chain.h"
#include "daemon/simulation/mapping/wrist.h"
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

}  // namespace
}  // namespace footing::mapping
