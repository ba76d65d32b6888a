#include "daemon/simulation/service/board_impulse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "common/virtual/noise/random.h"

namespace footing::simulation {
namespace {

using Feet = std::array<momentum::FootLoads, momentum::kFeet>;

constexpr double kStepS = 1 / 120.0;
constexpr double kWeightN = 700;

/// One foot of somebody who hops: 0 for half of the time, then a push of twice the weight.
double Hop(double time_s) {
  const double phase = time_s * 2.3 - std::floor(time_s * 2.3);
  return phase < 0.5
             ? 0
             : kWeightN * std::numbers::pi / 2 * std::sin((phase - 0.5) * 2 * std::numbers::pi);
}

Feet OnBoards() {
  Feet feet;
  for (momentum::FootLoads& foot : feet) {
    foot.valid = true;
    foot.count = kBoardCells;
  }
  return feet;
}

double Total(const Feet& feet) {
  double total_n = 0;
  for (const momentum::FootLoads& foot : feet) {
    for (std::size_t i = 0; i < foot.count; ++i) total_n += foot.cells[i].load_n;
  }
  return total_n;
}

/// Two boards that are sampled some 100 times a second, each in its own time, and are told of every
/// 10 ms; the engine steps at 120 Hz.
struct Boards {
  std::array<ImpulseMeter, momentum::kFeet> meters;
  std::array<double, momentum::kFeet> next_s{10, 10.004};
  LoadPlayer player;
  Feet feet = OnBoards();
  noise::Random random{3};
  double tick_s = 10.05;

  /// Everything that came until then; what the newest samples have is in `feet`.
  void Hear(double now_s) {
    for (; tick_s <= now_s; tick_s += 0.01) {
      for (std::size_t f = 0; f < meters.size(); ++f) {
        for (; next_s[f] <= tick_s; next_s[f] += 0.01 + 0.004 * (random.Uniform() - 0.5)) {
          const double cell_n = Hop(next_s[f]) / kBoardCells;
          meters[f].Add(next_s[f], {cell_n, cell_n, cell_n, cell_n});
          for (momentum::Cell& cell : feet[f].cells) cell.load_n = cell_n;
        }
        player.Take(f, meters[f].impulse());
      }
    }
  }
};

TEST(LoadPlayer, NoImpulseIsLostWhereHeldSamplesLoseThem) {
  Boards boards;
  // The change of a velocity of 70 kg that is right if each step has its mean load.
  double played_ns = 0, held_ns = 0, worst_played = 0, worst_held = 0, felt_ns = 0;
  constexpr double kPerKg = 2 * kWeightN / 9.80665;
  for (int i = 0; i < 120 * 20; ++i) {
    const double now_s = 10.06 + i * kStepS;
    boards.Hear(now_s);
    Feet told = boards.feet;
    const bool plays = boards.player.Advance(kStepS, told);
    EXPECT_TRUE(plays || i < 5) << i;
    if (i < 60) continue;  // Until the delay is what it should be.
    played_ns += Total(told) * kStepS;
    held_ns += Total(boards.feet) * kStepS;
    constexpr int kParts = 20;
    for (int k = 0; k < kParts; ++k) {
      felt_ns += 2 * Hop(now_s - (k + 0.5) / kParts * kStepS) * kStepS / kParts;
    }
    // At the end of whole hops, when neither the delay nor the shape of a push counts.
    if (Hop(now_s) > 0 || Hop(now_s - 0.06) > 0) continue;
    worst_played = std::max(worst_played, std::abs(played_ns - felt_ns) / kPerKg);
    worst_held = std::max(worst_held, std::abs(held_ns - felt_ns) / kPerKg);
  }
  EXPECT_LT(worst_played, 0.06);  // m/s, after forty hops.
  EXPECT_GT(worst_held, 2 * worst_played);
}

TEST(LoadPlayer, BeginsAnewAfterAGapAndTellsNothingUntilThen) {
  Boards boards;
  for (int i = 0; i < 60; ++i) {
    boards.Hear(10.06 + i * kStepS);
    Feet told = boards.feet;
    boards.player.Advance(kStepS, told);
  }
  boards.player.Take(0, {});
  Feet told = boards.feet;
  EXPECT_FALSE(boards.player.Advance(kStepS, told)) << "a board is lost";
  EXPECT_EQ(Total(told), Total(boards.feet));
  int silent = 0;
  for (int i = 60; i < 120; ++i) {
    boards.Hear(10.06 + i * kStepS);
    told = boards.feet;
    silent += boards.player.Advance(kStepS, told) ? 0 : 1;
    EXPECT_LT(std::abs(Total(told)), 4 * kWeightN);
  }
  EXPECT_LT(silent, 8);
  EXPECT_GT(silent, 1);
}

TEST(ImpulseMeter, AddsUpTrapezoidsAndNothingAcrossAGap) {
  ImpulseMeter meter;
  EXPECT_FALSE(meter.impulse().valid);
  meter.Add(0, {1, 2, 3, 4});
  EXPECT_FALSE(meter.impulse().valid) << "no time";
  meter.Add(5, {0, 2, 3, 4});
  meter.Add(5.1, {2, 2, 3, 4});
  EXPECT_TRUE(meter.impulse().valid);
  EXPECT_NEAR(meter.impulse().impulse_ns[0], 0.1, 1e-9);
  EXPECT_NEAR(meter.impulse().impulse_ns[3], 0.4, 1e-9);
  meter.Add(5.05, {100, 100, 100, 100});
  EXPECT_DOUBLE_EQ(meter.impulse().sampled_s, 5.1) << "out of order";
  meter.Add(7, {100, 100, 100, 100});
  EXPECT_NEAR(meter.impulse().impulse_ns[3], 0.4, 1e-9);
  EXPECT_DOUBLE_EQ(meter.impulse().sampled_s, 7);
}

}  // namespace
}  // namespace footing::simulation
