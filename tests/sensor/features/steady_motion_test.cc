#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "tests/sensor/features/chain.h"

/// Steady motion: the numbers of the gait paper's section 6 against those the motion was made from.
namespace footing::features {
namespace {

using wrists::HandMotion;
using wrists::Segment;
using wrists::Shape;
using wrists::WristShape;

struct Made {
  double frequency_hz;
  double phase_rad;
  double amplitude_mps2;
  bool wrist;
};

class SteadyMotion : public testing::TestWithParam<Made> {
 protected:
  /// The features at every instant of 4 cycles, after 3 cycles and 0.5 s.
  std::vector<Instant> Settled(double roll_rad = 0, double pitch_rad = 0) const {
    const Made made = GetParam();
    const double before_s = 0.5 + 3 / made.frequency_hz;
    const Segment swing{before_s + 4 / made.frequency_hz,
                        made.frequency_hz,
                        made.phase_rad,
                        made.amplitude_mps2,
                        roll_rad,
                        pitch_rad};
    std::vector<Instant> settled;
    for (const Instant& instant :
         RunChain(HandMotion({swing}, made.wrist ? WristShape() : Shape(), 0))) {
      if (instant.t_s >= before_s) settled.push_back(instant);
    }
    return settled;
  }
};

TEST_P(SteadyMotion, IsMovingAllTheTime) {
  for (const auto& instant : Settled()) {
    EXPECT_TRUE(instant.rig.devices[0].moving) << instant.t_s;
    EXPECT_TRUE(instant.rig.devices[1].moving) << instant.t_s;
  }
}

TEST_P(SteadyMotion, HasItsFrequencyWithin0_03Hz) {
  for (const auto& instant : Settled()) {
    ASSERT_TRUE(instant.rig.devices[0].frequency_valid) << instant.t_s;
    EXPECT_NEAR(instant.rig.devices[0].frequency_hz, GetParam().frequency_hz, 0.03);
  }
}

TEST_P(SteadyMotion, HasItsPhaseWithin5Degrees) {
  for (const auto& instant : Settled()) {
    ASSERT_TRUE(instant.rig.pairs[0].phase_valid) << instant.t_s;
    const double error = WrapAngle(instant.rig.pairs[0].phase_rad - GetParam().phase_rad);
    EXPECT_NEAR(RadiansToDegrees(error), 0, 5);
  }
}

TEST_P(SteadyMotion, HasItsAmplitudeWithin5PercentOrACount) {
  const double allowed = std::max(0.05 * GetParam().amplitude_mps2, 0.373);
  for (const auto& instant : Settled()) {
    ASSERT_TRUE(instant.rig.devices[1].amplitude_valid) << instant.t_s;
    EXPECT_NEAR(instant.rig.devices[1].amplitude_mps2, GetParam().amplitude_mps2, allowed);
  }
}

TEST_P(SteadyMotion, HasItsInclinationWithin2Degrees) {
  for (const auto& instant : Settled(DegreesToRadians(20), DegreesToRadians(-15))) {
    const auto& left = instant.rig.devices[0];
    ASSERT_TRUE(left.inclination_valid) << instant.t_s;
    EXPECT_NEAR(RadiansToDegrees(left.roll_rad), 20, 2);
    EXPECT_NEAR(RadiansToDegrees(left.pitch_rad), -15, 2);
  }
}

INSTANTIATE_TEST_SUITE_P(Swings, SteadyMotion,
                         testing::Values(Made{0.5, kPi, 4, false}, Made{0.5, 0, 4, true},
                                         Made{1.07, 0.5, 6, true}, Made{1.9, kPi, 8, true},
                                         Made{2.6, -2.0, 12, false}, Made{3.3, 0, 5, true},
                                         Made{4.5, kPi, 4, false}, Made{4.5, 1.2, 18, true}));

TEST(Phase, IsPositiveWhenTheRightOneLeads) {
  // The right hand does a quarter of a cycle before what the left one does.
  const auto instants = RunChain(HandMotion({{4, 1.5, kPi / 2, 8, 0, 0}}, Shape(), 0));
  EXPECT_NEAR(instants.back().rig.pairs[0].phase_rad, kPi / 2, 0.05);
}

TEST(Phase, OfAlternatingHandsIsHalfACycleAndNeverMinusHalf) {
  for (const auto& instant : RunChain(HandMotion({{5, 2, kPi, 8, 0, 0}}, WristShape(), 0))) {
    if (!instant.rig.pairs[0].phase_valid) continue;
    EXPECT_GT(instant.rig.pairs[0].phase_rad, -kPi);
    EXPECT_LE(instant.rig.pairs[0].phase_rad, kPi);
  }
}

TEST(Frequency, OfAStrongSecondHarmonicIsNotDoubled) {
  Shape shape;
  shape.second = 0.8;
  const auto instants = RunChain(HandMotion({{5, 1.2, 0, 10, 0, 0}}, shape, 0));
  EXPECT_NEAR(instants.back().rig.devices[0].frequency_hz, 1.2, 0.03);
}

TEST(Inclination, AtRestIsTheArcSineOfTheAxisOverG) {
  const double roll = DegreesToRadians(25);
  const double pitch = DegreesToRadians(-40);
  const auto instants = RunChain(HandMotion({{1, 1, 0, 0, roll, pitch}}, Shape(), 0));
  const auto& left = instants.back().rig.devices[0];
  EXPECT_FALSE(left.moving);
  // One count of 0.373 m/s² at 40 degrees: 0.373 / 2 / (g cos 40) = 1.4 degrees.
  EXPECT_NEAR(RadiansToDegrees(left.roll_rad), 25, 1.5);
  EXPECT_NEAR(RadiansToDegrees(left.pitch_rad), -40, 1.5);
}

/// Peaks beyond +-3 g: 2 x the bounds of free motion.
class ClippedMotion : public testing::TestWithParam<Made> {};

TEST_P(ClippedMotion, KeepsTwiceTheBounds) {
  const Made made = GetParam();
  const double settled_s = 0.5 + 3 / made.frequency_hz;
  const double roll = DegreesToRadians(10);
  const Segment swing{settled_s + 4 / made.frequency_hz,
                      made.frequency_hz,
                      made.phase_rad,
                      made.amplitude_mps2,
                      roll,
                      0};
  for (const auto& instant :
       RunChain(HandMotion({swing}, made.wrist ? WristShape() : Shape(), 0))) {
    if (instant.t_s < settled_s) continue;
    const auto& left = instant.rig.devices[0];
    ASSERT_TRUE(left.frequency_valid && left.amplitude_valid && left.inclination_valid);
    EXPECT_NEAR(left.frequency_hz, made.frequency_hz, 0.06);
    EXPECT_NEAR(left.amplitude_mps2, made.amplitude_mps2, 0.1 * made.amplitude_mps2);
    EXPECT_NEAR(RadiansToDegrees(left.roll_rad), 10, 4);
    EXPECT_NEAR(RadiansToDegrees(left.pitch_rad), 0, 4);
    const double error = WrapAngle(instant.rig.pairs[0].phase_rad - made.phase_rad);
    EXPECT_NEAR(RadiansToDegrees(error), 0, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Swings, ClippedMotion,
                         testing::Values(Made{1.0, kPi, 30, false}, Made{2.2, 0, 36, true},
                                         Made{3.5, kPi, 33, true}, Made{4.5, 0.7, 40, false}));

TEST(ClippedMotion, HoldsWhenThereIsTooLittleLeftToFit) {
  wrists::SensorModel narrow;
  const HandMotion motion({{3, 2, 0, 15, 0, 0}, {2, 2, 0, 150, 0, 0}}, Shape(), 0);
  const auto instants = RunChain(motion, narrow);
  const auto& before = instants[295].rig.devices[0];
  const auto& after = instants.back().rig.devices[0];
  EXPECT_FALSE(before.held);
  EXPECT_TRUE(after.held);
  EXPECT_TRUE(after.amplitude_valid);
  EXPECT_TRUE(AllFinite(instants.back().rig));
}

}  // namespace
}  // namespace footing::features
