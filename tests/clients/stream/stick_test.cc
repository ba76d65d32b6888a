#include "clients/stream/stick.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"

namespace footing::stream_client {
namespace {

wrists::Segment Swing(double duration_s, double frequency_hz, double phase_rad,
                      double roll_rad = 0) {
  wrists::Segment segment;
  segment.duration_s = duration_s;
  segment.frequency_hz = frequency_hz;
  segment.phase_rad = phase_rad;
  segment.amplitude_mps2 = frequency_hz > 0 ? 7 : 0;
  segment.roll_rad = roll_rad;
  return segment;
}

double Radius(const StickState& state) { return std::hypot(state.x, state.y); }

TEST(StickMotion, WalksInsideTheBorderOfThePaperAndRunsOutside) {
  const StickMotion stick({Swing(2, 0, 0), Swing(2, 1.3, kPi), Swing(2, 3, kPi)}, 0.2);
  EXPECT_EQ(Radius(stick.At(1)), 0);
  EXPECT_GT(Radius(stick.At(3)), 0.2);
  EXPECT_LT(Radius(stick.At(3)), 0.6);
  EXPECT_GT(Radius(stick.At(5)), 0.6);
  EXPECT_LE(Radius(stick.At(5)), 1);
  EXPECT_EQ(stick.At(5).x, 0);
  EXPECT_EQ(stick.DurationSeconds(), 6);
}

TEST(StickMotion, MovesWithoutAJump) {
  const StickMotion stick({Swing(2, 0, 0), Swing(2, 3, kPi, 0.3), Swing(2, 1.3, kPi, -0.3)}, 0.2);
  StickState last = stick.At(0);
  for (double t_s = 0; t_s < 6; t_s += 0.01) {
    const StickState now = stick.At(t_s);
    EXPECT_LT(std::hypot(now.x - last.x, now.y - last.y), 0.09) << t_s;
    last = now;
  }
}

TEST(StickMotion, TurnsToTheSideOfTheInclination) {
  const double roll_rad = 20 * kPi / 180;
  const StickMotion stick({Swing(2, 1.3, kPi, roll_rad), Swing(2, 1.3, kPi, -roll_rad)}, 0.2);
  EXPECT_GT(stick.At(1).x, 0.3);
  EXPECT_GT(stick.At(1).y, 0.1);
  EXPECT_LT(stick.At(3).x, -0.3);
}

TEST(StickMotion, PressesTheButtonOnceACycleOfHandsInPhase) {
  const StickMotion stick({Swing(3, 2, 0)}, 0.2);
  int presses = 0;
  bool last = false;
  for (int i = 0; i < 300; ++i) {
    const bool jump = stick.At(i * 0.01).jump;
    if (jump && !last) ++presses;
    last = jump;
  }
  EXPECT_EQ(presses, 6);
  EXPECT_FALSE(StickMotion({Swing(3, 2, kPi)}, 0.2).At(0).jump);
}

}  // namespace
}  // namespace footing::stream_client
