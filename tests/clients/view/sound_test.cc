#include "clients/view/scene/sound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace footing::scene {
namespace {

constexpr int kRateHz = 44100;

double PeakOf(const std::vector<float>& samples, double from_s, double to_s) {
  double peak = 0;
  for (auto i = static_cast<std::size_t>(from_s * kRateHz);
       i < std::min(samples.size(), static_cast<std::size_t>(to_s * kRateHz)); ++i) {
    peak = std::max(peak, std::abs(static_cast<double>(samples[i])));
  }
  return peak;
}

Sound SoundOf(SoundKind kind, double impact_mps) {
  return {kind, impact_mps, GainOfImpact(impact_mps), 0, 7, 1, 0};
}

TEST(Synthesis, ThePeakIsTheGainAndGrowsWithTheImpact) {
  double before = 0;
  for (const double impact_mps : {0.0, 0.3, 1.0, 2.5, 8.0}) {
    const double gain = GainOfImpact(impact_mps);
    EXPECT_GT(gain, before);
    EXPECT_LE(gain, 1);
    EXPECT_NEAR(PeakOf(Synthesized(SoundOf(SoundKind::kStep, impact_mps), kRateHz), 0, 1), gain,
                1e-6);
    before = gain;
  }
}

TEST(Synthesis, ImpactsBeginAtOnceAndDieAway) {
  for (const SoundKind kind : {SoundKind::kStep, SoundKind::kLanding}) {
    for (const double impact_mps : {0.2, 1.0, 3.0}) {
      const Sound sound = SoundOf(kind, impact_mps);
      const std::vector<float> samples = Synthesized(sound, kRateHz);
      const double end_s = static_cast<double>(samples.size()) / kRateHz;
      EXPECT_GT(PeakOf(samples, 0, 0.03), 0.95 * sound.gain) << "the peak is in the first 30 ms";
      EXPECT_LT(PeakOf(samples, 0.6 * end_s, end_s), 0.15 * sound.gain);
      EXPECT_EQ(samples.front(), 0);
      EXPECT_EQ(samples.back(), 0);
    }
  }
}

TEST(Synthesis, ALandingLastsLongerThanAStep) {
  EXPECT_GT(Synthesized(SoundOf(SoundKind::kLanding, 2), kRateHz).size(),
            2 * Synthesized(SoundOf(SoundKind::kStep, 2), kRateHz).size());
}

TEST(Synthesis, WingsSwellAndFadeTwice) {
  const std::vector<float> samples = Synthesized(SoundOf(SoundKind::kWings, 0.5), kRateHz);
  const double end_s = static_cast<double>(samples.size()) / kRateHz;
  const double first = PeakOf(samples, 0.15 * end_s, 0.35 * end_s);
  const double between = PeakOf(samples, 0.48 * end_s, 0.52 * end_s);
  const double second = PeakOf(samples, 0.65 * end_s, 0.85 * end_s);
  EXPECT_LT(between, 0.1 * first);
  EXPECT_GT(second, 3 * between);
  EXPECT_LT(second, first);
}

TEST(Synthesis, TheSameSoundHasTheSameSamplesAndAllAreNumbers) {
  for (const SoundKind kind : {SoundKind::kStep, SoundKind::kLanding, SoundKind::kWings}) {
    Sound sound = SoundOf(kind, 1.3);
    const std::vector<float> samples = Synthesized(sound, kRateHz);
    EXPECT_EQ(samples, Synthesized(sound, kRateHz));
    sound.seed = 8;
    EXPECT_NE(samples, Synthesized(sound, kRateHz));
    for (const int rate_hz : {8000, 48000}) {
      for (const float sample : Synthesized(sound, rate_hz)) ASSERT_TRUE(std::isfinite(sample));
    }
  }
}

Camera Behind() {
  Camera camera;
  camera.eye_m = {-4, 0, 2.5};  // Nearer than from where sounds grow fainter.
  camera.target_m = {2, 0, 1};
  return camera;
}

/// Pictures at 60 Hz of a body on two feet; `pose_at` says how it is at a time.
using PoseAt = std::function<CharacterPose(double time_s)>;

std::vector<Sound> SoundsOf(const PoseAt& pose_at, double seconds) {
  SoundFinder finder;
  std::vector<Sound> all;
  for (double time_s = 0; time_s < seconds; time_s += 1.0 / 60) {
    WorldFrame frame;
    frame.time_s = time_s;
    frame.characters = {pose_at(time_s)};
    const auto sounds = finder.Advance(frame, Behind(), 16.0 / 9);
    all.insert(all.end(), sounds.begin(), sounds.end());
  }
  return all;
}

CharacterPose Standing() {
  CharacterPose pose;
  pose.character = 1;
  pose.valid = true;
  pose.com_m = {0, 0, 1};
  pose.contacts = {{true, {0, 0.1, 0}, 300}, {true, {0, -0.1, 0}, 300}};
  return pose;
}

/// Left and right foot in turn, a step each half second.
CharacterPose WalkingAt(double time_s) {
  CharacterPose pose = Standing();
  const double phase = std::fmod(time_s, 1.0);
  pose.contacts[0].touching = phase < 0.55;
  pose.contacts[1].touching = phase < 0.05 || phase >= 0.5;
  return pose;
}

/// A hop of 0.5 m each second: 0.64 s in the air, landing at 3.1 m/s.
CharacterPose HoppingAt(double time_s) {
  CharacterPose pose = Standing();
  constexpr double kFlightS = 0.64;
  const double flown_s = std::fmod(time_s, 1.0) - 0.3;
  if (flown_s < 0 || flown_s > kFlightS) return pose;
  const double height_m = 9.81 / 2 * flown_s * (kFlightS - flown_s);
  pose.com_velocity_mps.z() = 9.81 * (kFlightS / 2 - flown_s);
  pose.com_m.z() += height_m;
  for (stream::Contact& foot : pose.contacts) {
    foot.touching = false;
    foot.position_m.z() = height_m;
  }
  return pose;
}

TEST(SoundFinder, EachTouchdownOfAWalkIsAStepOnItsSide) {
  const std::vector<Sound> sounds = SoundsOf(WalkingAt, 4.9);
  ASSERT_EQ(sounds.size(), 9u);  // At 0.5, 1, 1.5, ..., 4.5 s.
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    EXPECT_EQ(sounds[i].kind, SoundKind::kStep);
    // The right foot is the first to touch, and to the right in the picture.
    EXPECT_EQ(sounds[i].foot, i % 2 == 0 ? 1 : 0);
    EXPECT_GT(i % 2 == 0 ? sounds[i].pan : -sounds[i].pan, 0.01);
  }
}

TEST(SoundFinder, AJumpHasWingsAndThenALandingAsHardAsItFell) {
  const std::vector<Sound> sounds = SoundsOf(HoppingAt, 1.2);
  ASSERT_EQ(sounds.size(), 3u);
  EXPECT_EQ(sounds[0].kind, SoundKind::kWings);
  EXPECT_EQ(sounds[1].kind, SoundKind::kLanding);
  EXPECT_EQ(sounds[2].kind, SoundKind::kStep) << "the other foot lands with it";
  EXPECT_NEAR(sounds[1].impact_mps, 9.81 * 0.32, 0.2);
  EXPECT_NEAR(sounds[1].gain, GainOfImpact(sounds[1].impact_mps), 0.01);
}

TEST(SoundFinder, AHarderTouchdownIsLouder) {
  const auto step_at = [](double descent_mps) {
    return [descent_mps](double time_s) {
      CharacterPose pose = WalkingAt(time_s);
      pose.com_velocity_mps.z() = -descent_mps;
      return pose;
    };
  };
  EXPECT_GT(SoundsOf(step_at(1.2), 0.6).at(0).gain, SoundsOf(step_at(0.2), 0.6).at(0).gain + 0.1);
}

TEST(SoundFinder, AStandingAFrozenAndAnInvalidBodyAreSilent) {
  EXPECT_TRUE(SoundsOf([](double) { return Standing(); }, 3).empty());
  EXPECT_TRUE(SoundsOf(
                  [](double time_s) {
                    CharacterPose pose = WalkingAt(time_s);
                    pose.valid = false;
                    return pose;
                  },
                  3)
                  .empty());
  SoundFinder finder;
  WorldFrame frame;
  frame.characters = {WalkingAt(0.3)};
  finder.Advance(frame, Behind(), 1);
  frame.characters = {WalkingAt(0.6)};  // The time stands still.
  EXPECT_TRUE(finder.Advance(frame, Behind(), 1).empty());
}

TEST(SoundFinder, NothingSoundsAcrossASeekOrWhereABodyWasPutBack) {
  SoundFinder finder;
  WorldFrame frame;
  frame.characters = {WalkingAt(0.3)};
  finder.Advance(frame, Behind(), 1);
  frame.time_s = 5;
  frame.characters = {WalkingAt(0.6)};
  EXPECT_TRUE(finder.Advance(frame, Behind(), 1).empty()) << "a seek";
  frame.time_s = 5.02;
  frame.characters = {WalkingAt(1.2)};
  finder.Advance(frame, Behind(), 1);
  frame.time_s = 5.04;
  frame.characters = {WalkingAt(1.6)};
  frame.characters[0].com_m.x() = -10;
  EXPECT_TRUE(finder.Advance(frame, Behind(), 1).empty()) << "put back";
}

}  // namespace
}  // namespace footing::scene
