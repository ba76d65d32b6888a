#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "tests/sensor/features/chain.h"

/// Links that lose, repeat and delay, samples that make no sense, rigs of every kind.
namespace footing::features {
namespace {

using stream::DeviceRole;
using wrists::HandMotion;
using wrists::Shape;

HandMotion Walk() { return HandMotion({{6, 1.5, kPi, 8, 0.2, 0}}, Shape(), 0); }

stream::RigFeatures After(RigFeatureExtractor rig,
                          const std::vector<stream::MotionSample>& samples) {
  for (const auto& sample : samples) {
    rig.AddSample(sample);
    rig.Compute(sample.sampled_ns);
  }
  return rig.Compute(samples.back().sampled_ns);
}

TEST(Links, AThirdOfTheSamplesLostAndStampsThatJitterChangeLittle) {
  wrists::SensorModel model;
  model.jitter_s = 0.003;
  noise::Random random(5);
  std::vector<stream::MotionSample> kept;
  for (const auto& sample : Samples(Walk(), model)) {
    if (random.Uniform() > 0.33) kept.push_back(sample);
  }
  const auto rig = After(TwoHands(), kept);
  EXPECT_NEAR(rig.devices[0].frequency_hz, 1.5, 0.03);
  EXPECT_NEAR(WrapAngle(rig.pairs[0].phase_rad - kPi), 0, DegreesToRadians(5));
  EXPECT_NEAR(rig.devices[0].amplitude_mps2, 8, 0.4);
}

TEST(Links, RepeatsOfASixtyHertzSensorAreNoSteps) {
  wrists::SensorModel slow;
  slow.rate_hz = 60;
  std::vector<stream::MotionSample> samples;
  for (auto sample : Samples(Walk(), slow)) {
    sample.repeated = false;
    samples.push_back(sample);
    sample.sampled_ns += 8'000'000;  // Sent again before the sensor has a new value.
    sample.repeated = true;
    samples.push_back(sample);
  }
  const auto rig = After(TwoHands(), samples);
  EXPECT_NEAR(rig.devices[0].frequency_hz, 1.5, 0.03);
  EXPECT_NEAR(WrapAngle(rig.pairs[0].phase_rad - kPi), 0, DegreesToRadians(5));
}

TEST(Links, AStillControllerThatOnlyRepeatsItselfHasFeatures) {
  stream::MotionSample sample;
  sample.device = kLeft;
  sample.specific_force_mps2 = sample.filtered_mps2 = Eigen::Vector3d(0, 0, -9.81);
  auto rig = TwoHands();
  for (int i = 0; i < 100; ++i) {
    sample.sampled_ns = i * kGridStepNs;
    sample.repeated = i > 0;
    rig.AddSample(sample);
  }
  const auto features = rig.Compute(sample.sampled_ns);
  EXPECT_FALSE(features.devices[0].moving);
  EXPECT_TRUE(features.devices[0].inclination_valid);
}

TEST(Links, WithoutSamplesForHalfASecondThereAreNoFeatures) {
  auto rig = TwoHands();
  const auto samples = Samples(Walk(), {});
  for (const auto& sample : samples) rig.AddSample(sample);
  EXPECT_TRUE(rig.Compute(samples.back().sampled_ns).devices[0].moving);
  const auto late = rig.Compute(samples.back().sampled_ns + 600'000'000);
  EXPECT_FALSE(late.devices[0].moving);
  EXPECT_FALSE(late.devices[0].inclination_valid);
  EXPECT_FALSE(late.pairs[0].phase_valid);
}

TEST(Links, AClockThatStartsAnewIsFollowed) {
  auto rig = TwoHands();
  const auto samples = Samples(Walk(), {});
  for (auto sample : samples) {
    sample.sampled_ns += 1'000 * kNanosecondsPerSecond;
    rig.AddSample(sample);
    rig.Compute(sample.sampled_ns);
  }
  const auto again = After(rig, samples);
  EXPECT_TRUE(again.devices[0].moving);
  EXPECT_NEAR(again.devices[0].frequency_hz, 1.5, 0.03);
}

TEST(Samples, ThatAreNotFiniteOrOfAnotherDeviceAreIgnored) {
  const auto samples = Samples(Walk(), {});
  std::vector<stream::MotionSample> spoiled;
  for (const auto& sample : samples) {
    spoiled.push_back(sample);
    spoiled.push_back(sample);
    spoiled.back().sampled_ns += 5'000'000;
    spoiled.back().filtered_mps2.y() = std::numeric_limits<double>::infinity();
    spoiled.push_back(sample);
    spoiled.back().device = 99;
  }
  const auto clean = After(TwoHands(), samples);
  const auto dirty = After(TwoHands(), spoiled);
  EXPECT_EQ(clean.devices[0].frequency_hz, dirty.devices[0].frequency_hz);
  EXPECT_EQ(clean.pairs[0].phase_rad, dirty.pairs[0].phase_rad);
}

TEST(Samples, OfAnyKindNeverMakeAFeatureThatIsNotFinite) {
  noise::Random random(17);
  auto rig = TwoHands();
  std::int64_t now_ns = 0;
  for (int i = 0; i < 6000; ++i) {
    stream::MotionSample sample;
    sample.device = random.Uniform() < 0.5 ? kLeft : kRight;
    now_ns += static_cast<std::int64_t>(random.Uniform(-1e6, 2e7));
    sample.sampled_ns = random.Uniform() < 0.01 ? -now_ns : now_ns;
    const double size = std::pow(10.0, random.Uniform(-9, 9));
    sample.specific_force_mps2 =
        size * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal());
    sample.filtered_mps2 = sample.specific_force_mps2;
    sample.clipped_axes = static_cast<std::uint32_t>(random.Uniform(0, 8));
    sample.repeated = random.Uniform() < 0.2;
    rig.AddSample(sample);
    ASSERT_TRUE(AllFinite(rig.Compute(now_ns))) << i;
  }
}

TEST(Rigs, OfThreeControllersHaveThreeFeaturesAndOnePair) {
  const RigFeatureExtractor rig(
      "bob", {{1, DeviceRole::kLeftLeg}, {2, DeviceRole::kRightLeg}, {3, DeviceRole::kHead}});
  std::vector<stream::MotionSample> samples;
  for (auto sample : Samples(Walk(), {})) {
    sample.device = sample.device == kLeft ? 1 : 2;
    samples.push_back(sample);
    if (sample.device == 2) continue;
    sample.device = 3;
    sample.specific_force_mps2 = sample.filtered_mps2 = wrists::InclinedGravity(0.3, 0);
    samples.push_back(sample);
  }
  const auto features = After(rig, samples);
  ASSERT_EQ(features.devices.size(), 3u);
  ASSERT_EQ(features.pairs.size(), 1u);
  EXPECT_EQ(features.rig, "bob");
  EXPECT_NEAR(std::abs(features.pairs[0].phase_rad), kPi, 0.1);
  EXPECT_FALSE(features.devices[2].moving);
  EXPECT_NEAR(features.devices[2].roll_rad, 0.3, 1e-6);
}

TEST(Rigs, OfOneControllerOrNoneHaveNoPair) {
  EXPECT_TRUE(RigFeatureExtractor("", {}).Compute(0).devices.empty());
  RigFeatureExtractor one("x", {{1, DeviceRole::kLeftHand}});
  EXPECT_TRUE(one.Compute(0).pairs.empty());
  EXPECT_FALSE(one.Compute(0).devices[0].moving);
}

TEST(Rigs, ThatAreCopiedContinueBitForBit) {
  const auto samples = Samples(Walk(), {});
  auto rig = TwoHands();
  for (std::size_t i = 0; i < 500; ++i) rig.AddSample(samples[i]);
  rig.Compute(samples[499].sampled_ns);
  auto copy = rig;
  for (std::size_t i = 500; i < samples.size(); ++i) {
    rig.AddSample(samples[i]);
    copy.AddSample(samples[i]);
    const auto one = rig.Compute(samples[i].sampled_ns);
    const auto two = copy.Compute(samples[i].sampled_ns);
    EXPECT_EQ(one.devices[0].frequency_hz, two.devices[0].frequency_hz);
    EXPECT_EQ(one.devices[1].amplitude_mps2, two.devices[1].amplitude_mps2);
    EXPECT_EQ(one.pairs[0].phase_rad, two.pairs[0].phase_rad);
  }
}

}  // namespace
}  // namespace footing::features
