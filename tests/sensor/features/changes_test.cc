#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/base/units.h"
#include "tests/sensor/features/chain.h"

/// How long after a change of motion the features are right, and stay so.
namespace footing::features {
namespace {

using wrists::HandMotion;
using wrists::Segment;
using wrists::Shape;

using Right = std::function<bool(const stream::RigFeatures&)>;

double Delay(const std::vector<Segment>& segments, double start_angle_rad, const Right& right) {
  const HandMotion motion(segments, Shape(), 0, start_angle_rad);
  const double change_s = segments.front().duration_s;
  double since_s = INFINITY;
  for (const auto& instant : RunChain(motion)) {
    if (instant.t_s < change_s) continue;
    if (!right(instant.rig)) {
      since_s = INFINITY;
    } else if (std::isinf(since_s)) {
      since_s = instant.t_s;
    }
  }
  return since_s - change_s;
}

Segment Swing(double frequency_hz, double phase_rad, double cycles, double amplitude_mps2 = 6) {
  return {cycles / frequency_hz, frequency_hz, phase_rad, amplitude_mps2, 0, 0};
}

Right Moving(bool moving) {
  return [moving](const stream::RigFeatures& rig) {
    return rig.devices[0].moving == moving && rig.devices[1].moving == moving;
  };
}
Right FrequencyNear(double frequency_hz) {
  return [frequency_hz](const stream::RigFeatures& rig) {
    const auto& left = rig.devices[0];
    return left.frequency_valid && std::abs(left.frequency_hz / frequency_hz - 1) < 0.05;
  };
}
Right PhaseNear(double phase_rad) {
  return [phase_rad](const stream::RigFeatures& rig) {
    return rig.pairs[0].phase_valid &&
           std::abs(WrapAngle(rig.pairs[0].phase_rad - phase_rad)) < DegreesToRadians(20);
  };
}

class Changes : public testing::TestWithParam<double> {};  // The hand's angle at the start.

TEST_P(Changes, AStartIsSeenWithin0_3Seconds) {
  for (const double f : {0.5, 1.0, 2.0, 4.5}) {
    EXPECT_LE(Delay({Segment{}, Swing(f, kPi, 4, 4)}, GetParam(), Moving(true)), 0.3) << f;
  }
}

TEST_P(Changes, AStopIsSeenWithin0_3SecondsOr0_45Cycles) {
  for (const double f : {0.5, 1.0, 1.5, 3.0, 4.5}) {
    const double allowed_s = f >= 1.5 ? 0.3 : 0.45 / f;
    Segment still;
    still.duration_s = 1.5;
    EXPECT_LE(Delay({Swing(f, kPi, 4.3), still}, GetParam(), Moving(false)), allowed_s) << f;
  }
}

TEST_P(Changes, AFrequencyIsKnownWithinTwoCyclesOfTheStart) {
  for (const double f : {0.5, 1.3, 4.5}) {
    EXPECT_LE(f * Delay({Segment{}, Swing(f, kPi, 5)}, GetParam(), FrequencyNear(f)), 2) << f;
  }
}

TEST_P(Changes, OneToThreeHertzIsKnownWithinTwoCyclesOfOneHertz) {
  EXPECT_LE(Delay({Swing(1, kPi, 4.2), Swing(3, kPi, 12)}, GetParam(), FrequencyNear(3)), 2);
}

TEST_P(Changes, ThreeToOneHertzIsKnownWithinTwoCyclesOfOneHertz) {
  EXPECT_LE(Delay({Swing(3, kPi, 9.2), Swing(1, kPi, 4)}, GetParam(), FrequencyNear(1)), 2);
}

TEST_P(Changes, OutOfPhaseToInPhaseIsKnownWithinTwoCycles) {
  for (const double f : {0.5, 1.5, 4.0}) {
    EXPECT_LE(f * Delay({Swing(f, kPi, 4.4), Swing(f, 0, 5)}, GetParam(), PhaseNear(0)), 2) << f;
    EXPECT_LE(f * Delay({Swing(f, 0, 4.4), Swing(f, kPi, 5)}, GetParam(), PhaseNear(kPi)), 2) << f;
  }
}

INSTANTIATE_TEST_SUITE_P(FromAngle, Changes, testing::Values(0.0, 1.3, 2.9, 4.6));

TEST(SlowTilt, IsNotMotion) {
  // 60 degrees in 2 s, by a blend whose fastest is 1.5 times its mean.
  const HandMotion motion({{1, 1, 0, 0, 0, 0}, {3, 1, 0, 0, DegreesToRadians(60), 0}}, Shape(), 2);
  for (const auto& instant : RunChain(motion)) {
    EXPECT_FALSE(instant.rig.devices[0].moving) << instant.t_s;
  }
}

}  // namespace
}  // namespace footing::features
