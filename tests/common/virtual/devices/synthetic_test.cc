#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"
#include "common/virtual/devices/accelerometer.h"
#include "common/virtual/devices/noise.h"

namespace footing::wrists {
namespace {

constexpr double kQuarter = kPi / 2;

Segment Swing(double frequency_hz, double phase_rad, double duration_s = 4) {
  return {duration_s, frequency_hz, phase_rad, 8.0, 0, 0};
}

TEST(Random, IsTheGeneratorOfTheStandard) {
  // [rand.predef]: the 10000th value of mt19937_64 with its default seed is 9981545732273789042.
  noise::Random random(std::mt19937_64::default_seed);
  double last = 0;
  for (int i = 0; i < 10000; ++i) last = random.Uniform();
  EXPECT_EQ(last, static_cast<double>(9981545732273789042ull >> 11) / 9007199254740992.0);
}

TEST(Random, NormalHasMeanZeroAndDeviationOne) {
  noise::Random random(1);
  double sum = 0;
  double squares = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.Normal();
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / kCount, 0, 4 / std::sqrt(kCount));
  EXPECT_NEAR(squares / kCount, 1, 0.05);
}

TEST(HandMotion, AtRestFaceUpItIsGravityAlongMinusZ) {
  const HandMotion motion({Segment{}}, Shape(), 0);
  EXPECT_LT((motion.At(0.5).left_mps2 - Eigen::Vector3d(0, 0, -9.80665)).norm(), 1e-12);
}

TEST(HandMotion, LeftSideHigherShowsOnPlusXAndFrontHigherOnPlusY) {
  const Eigen::Vector3d force = InclinedGravity(DegreesToRadians(30), DegreesToRadians(-20));
  EXPECT_NEAR(force.x(), kStandardGravityMps2 * 0.5, 1e-12);  // sin(30 degrees)
  EXPECT_NEAR(force.y(), kStandardGravityMps2 * std::sin(DegreesToRadians(-20)), 1e-12);
  EXPECT_NEAR(force.norm(), kStandardGravityMps2, 1e-12);
}

TEST(HandMotion, TheRightHandLeadsByThePhase) {
  const HandMotion motion({Swing(1.0, kQuarter)}, Shape(), 0);
  // A quarter of a cycle of 1 Hz is 0.25 s: what the right hand does now, the left one does then.
  for (double t = 0; t < 2; t += 0.07) {
    EXPECT_LT((motion.At(t).right_mps2 - motion.At(t + 0.25).left_mps2).norm(), 1e-9);
  }
}

TEST(HandMotion, HalfPeakToPeakIsTheAmplitudeForEveryShape) {
  for (const Shape& shape : {Shape(), WristShape()}) {
    const HandMotion motion({Swing(1.0, 0)}, shape, 0);
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < 1000; ++i) {
      const double along = motion.At(i * 0.001).left_mps2.dot(shape.direction_S.normalized());
      low = std::min(low, along);
      high = std::max(high, along);
    }
    EXPECT_NEAR(0.5 * (high - low), 8.0, 1e-3);
  }
}

TEST(HandMotion, ABlendLeavesNoJump) {
  const HandMotion motion({Swing(1.0, kPi, 2), Swing(3.0, 0, 2)}, WristShape(), 0.4);
  // 8 m/s² at 3 Hz, second harmonic and a phase that runs half a turn in 0.4 s: slopes stay below
  // 8 (1 + 2 * 0.3) (2 pi 3 + 1.5 pi / 0.4) < 400 m/s³.
  for (double t = 1.9; t < 2.6; t += 0.001) {
    EXPECT_LT((motion.At(t + 0.001).right_mps2 - motion.At(t).right_mps2).norm(), 0.4);
  }
}

TEST(HandMotion, AfterABlendTheNewPhaseHolds) {
  const HandMotion motion({Swing(2.0, kPi, 2), Swing(2.0, 0, 2)}, Shape(), 0.3);
  for (double t = 2.3; t < 4; t += 0.05) {
    EXPECT_LT((motion.At(t).right_mps2 - motion.At(t).left_mps2).norm(), 1e-9);
  }
}

TEST(HandMotion, TheLastStretchGoesOnAfterTheEnd) {
  const HandMotion motion({Swing(2.0, 0, 1)}, Shape(), 0);
  EXPECT_LT((motion.At(5.1).left_mps2 - motion.At(0.1).left_mps2).norm(), 1e-9);
}

TEST(Sensor, ValuesAreWholeCountsInsideTheRange) {
  const SensorModel model;
  noise::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d truth(random.Uniform(-40, 40), random.Uniform(-40, 40), 0);
    const SensorReading reading = Read(model, truth, random);
    for (int axis = 0; axis < 3; ++axis) {
      const double counts = reading.specific_force_mps2(axis) / model.quantum_mps2;
      EXPECT_NEAR(counts, std::round(counts), 1e-9);
      EXPECT_LE(std::abs(reading.specific_force_mps2(axis)), model.range_mps2);
    }
  }
}

TEST(Sensor, TheAxisAtTheEndOfTheRangeIsFlagged) {
  noise::Random random(4);
  const SensorReading reading = Read(SensorModel(), {0, 35, -35}, random);
  EXPECT_EQ(reading.clipped_axes, 0b110u);
}

TEST(Sensor, TheSameSeedRecordsTheSameBits) {
  const HandMotion motion({Swing(1.3, 1.0)}, WristShape(), 0);
  SensorModel model;
  model.jitter_s = 0.003;
  const auto one = Record(motion, model, 7);
  const auto two = Record(motion, model, 7);
  const auto other = Record(motion, model, 8);
  ASSERT_EQ(one.size(), 400u);  // 4 s of 100 Hz.
  std::size_t different = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].sampled_ns, two[i].sampled_ns);
    EXPECT_EQ(one[i].left.specific_force_mps2, two[i].left.specific_force_mps2);
    EXPECT_EQ(one[i].right.specific_force_mps2, two[i].right.specific_force_mps2);
    different += one[i].sampled_ns != other[i].sampled_ns ? 1 : 0;
  }
  EXPECT_GT(different, 300u);
}

}  // namespace
}  // namespace footing::wrists
