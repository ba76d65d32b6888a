#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/board/geometry.h"
#include "common/board/layout.h"
#include "common/virtual/devices/noise.h"

namespace footing::board {
namespace {

TEST(BoardGeometry, IsThatOfABalanceBoard) {
  EXPECT_EQ(kBalanceBoard, (stream::BoardGeometry{0.511, 0.316, 0.433, 0.238}));
  EXPECT_TRUE(IsSound(kBalanceBoard));
}

TEST(BoardGeometry, LengthsThatNoBoardHasAreNotSound) {
  for (const double bad :
       {0.0, -0.433, 0.099, 1.01, std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (double stream::BoardGeometry::*length :
         {&stream::BoardGeometry::plate_x_m, &stream::BoardGeometry::plate_y_m,
          &stream::BoardGeometry::sensor_distance_x_m,
          &stream::BoardGeometry::sensor_distance_y_m}) {
      stream::BoardGeometry geometry = kBalanceBoard;
      geometry.*length = bad;
      EXPECT_FALSE(IsSound(geometry)) << bad;
    }
  }
}

TEST(BoardGeometry, ABoardWithoutASoundPublishedOneIsABalanceBoard) {
  EXPECT_EQ(GeometryOr(std::nullopt), kBalanceBoard);
  const stream::BoardGeometry other{0.6, 0.4, 0.5, 0.3};
  EXPECT_EQ(GeometryOr(other), other);
  for (const double bad : {0.0, std::nan("")}) {
    EXPECT_EQ(GeometryOr(stream::BoardGeometry{0.6, 0.4, bad, 0.3}), kBalanceBoard);
  }
}

TEST(BoardGeometry, WithYawZeroTheFrontIsForward) {
  const Eigen::Vector2d at = InWorld({1, 2, 0}, 0.1, 0.2);
  EXPECT_NEAR(at.x(), 1.2, 1e-12);
  EXPECT_NEAR(at.y(), 1.9, 1e-12);  // Right is -y.
}

TEST(BoardGeometry, SensorsStandAtHalfTheirDistances) {
  const stream::BoardGeometry wide{0.511, 0.316, 0.866, 0.476};
  const auto places = SensorPlaces({1, 2, 0}, wide);
  EXPECT_NEAR(places[1].x(), 1 + 0.476 / 2, 1e-12);  // Top right.
  EXPECT_NEAR(places[1].y(), 2 - 0.866 / 2, 1e-12);
  EXPECT_NEAR(places[2].x(), 1 - 0.476 / 2, 1e-12);  // Bottom left.
  EXPECT_NEAR(places[2].y(), 2 + 0.866 / 2, 1e-12);
}

using Feet = std::array<Corners, LoadPlayer::kBoards>;

constexpr double kStepS = 1 / 120.0;
constexpr double kWeightN = 700;

/// One foot of somebody who hops: 0 for half of the time, then a push of twice the weight.
double Hop(double time_s) {
  const double phase = time_s * 2.3 - std::floor(time_s * 2.3);
  return phase < 0.5
             ? 0
             : kWeightN * std::numbers::pi / 2 * std::sin((phase - 0.5) * 2 * std::numbers::pi);
}

double Total(const Feet& feet) {
  double total_n = 0;
  for (const Corners& corners_n : feet) {
    for (const double load_n : corners_n) total_n += load_n;
  }
  return total_n;
}

/// Two boards that are sampled some 100 times a second, each in its own time, and are told of every
/// 10 ms; the engine steps at 120 Hz.
struct Boards {
  std::array<ImpulseMeter, LoadPlayer::kBoards> meters;
  std::array<double, LoadPlayer::kBoards> next_s{10, 10.004};
  LoadPlayer player;
  Feet feet{};
  noise::Random random{3};
  double tick_s = 10.05;

  /// Everything that came until then; what the newest samples have is in `feet`.
  void Hear(double now_s) {
    for (; tick_s <= now_s; tick_s += 0.01) {
      for (std::size_t f = 0; f < meters.size(); ++f) {
        for (; next_s[f] <= tick_s; next_s[f] += 0.01 + 0.004 * (random.Uniform() - 0.5)) {
          const double cell_n = Hop(next_s[f]) / kCorners;
          meters[f].Add(next_s[f], {cell_n, cell_n, cell_n, cell_n});
          feet[f].fill(cell_n);
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
    const auto played = boards.player.Advance(kStepS);
    EXPECT_TRUE(played || i < 5) << i;
    if (i < 60) continue;  // Until the delay is what it should be.
    played_ns += Total(*played) * kStepS;
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

TEST(LoadPlayer, StartsAgainAfterAGapAndPlaysNothingUntilThen) {
  Boards boards;
  for (int i = 0; i < 60; ++i) {
    boards.Hear(10.06 + i * kStepS);
    boards.player.Advance(kStepS);
  }
  boards.player.Take(0, {});
  EXPECT_FALSE(boards.player.Advance(kStepS)) << "a board is lost";
  int silent = 0;
  for (int i = 60; i < 120; ++i) {
    boards.Hear(10.06 + i * kStepS);
    const auto played = boards.player.Advance(kStepS);
    silent += played ? 0 : 1;
    EXPECT_LT(std::abs(Total(played.value_or(boards.feet))), 4 * kWeightN);
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

TEST(Plate, CentreOfPressureIsUnderTheLoadedCorner) {
  Plate plate;
  const PlateReading right_front = plate.Advance({0, 600, 0, 0});
  ASSERT_TRUE(right_front.cop_valid);
  EXPECT_DOUBLE_EQ(right_front.total_n, 600);
  EXPECT_DOUBLE_EQ(right_front.cop_x_m, 0.433 / 2);
  EXPECT_DOUBLE_EQ(right_front.cop_y_m, 0.238 / 2);
  const PlateReading left_rear = plate.Advance({0, 0, 600, 0});
  EXPECT_DOUBLE_EQ(left_rear.cop_x_m, -0.433 / 2);
  EXPECT_DOUBLE_EQ(left_rear.cop_y_m, -0.238 / 2);
}

TEST(Plate, CentreOfPressureIsTheWeightedMeanOfTheCorners) {
  Plate plate;
  // x: (300 - 100) / 400 of half the width; y: (250 - 150) / 400 of half the depth.
  const PlateReading reading = plate.Advance({60, 190, 40, 110});
  EXPECT_DOUBLE_EQ(reading.cop_x_m, 0.433 / 2 * (300.0 - 100.0) / 400.0);
  EXPECT_DOUBLE_EQ(reading.cop_y_m, 0.238 / 2 * (250.0 - 150.0) / 400.0);
}

TEST(Plate, EmptyOrNegativeItHasNoCentreOfPressureAndNoContact) {
  Plate plate;
  for (const double corner : {0.0, 0.3, -5.0, 12.0}) {
    const PlateReading reading = plate.Advance({corner, corner, corner, corner});
    EXPECT_FALSE(reading.cop_valid);
    EXPECT_FALSE(reading.contact);
    EXPECT_EQ(reading.cop_x_m, 0);
    EXPECT_EQ(reading.cop_y_m, 0);
  }
}

TEST(Plate, ContactBeginsAboveOneBorderAndEndsBelowAnother) {
  const PlateConfig config;  // On at 68.6 N, off at 49 N.
  Plate plate(config);
  const auto contact = [&plate](double total_n) {
    return plate.Advance({total_n, 0, 0, 0}).contact;
  };
  EXPECT_FALSE(contact(60));
  EXPECT_TRUE(contact(70));
  EXPECT_TRUE(contact(60));
  EXPECT_TRUE(contact(50));
  EXPECT_FALSE(contact(48));
  EXPECT_FALSE(contact(60));
}

TEST(Plate, TheSameReadingAgainIsARepeat) {
  Plate plate;
  EXPECT_FALSE(plate.Advance({0, 0, 0, 0}).repeated);
  EXPECT_TRUE(plate.Advance({0, 0, 0, 0}).repeated);
  EXPECT_FALSE(plate.Advance({0, 0, 0, 1e-9}).repeated);
}

}  // namespace
}  // namespace footing::board
