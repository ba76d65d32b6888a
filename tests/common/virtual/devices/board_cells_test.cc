#include "common/virtual/devices/board_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "common/base/units.h"

namespace footing::virtual_sensors {
namespace {

double Sum(const Corners& corners) { return std::accumulate(corners.begin(), corners.end(), 0.0); }

Eigen::Vector2d Cop(const BoardPlace& board, const Corners& corners) {
  const auto places = SensorPlaces(board);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) sum += corners[i] * places[i];
  return sum / Sum(corners);
}

TEST(LoadBoard, CornersGiveBackLoadAndCopOfAnyBoardThatIsTurned) {
  for (const double yaw : {0.0, 0.5, 1.5707963, -2.0}) {
    const BoardPlace board{{0.3, -0.2}, yaw};
    const FootForce foot{400, {0.35, -0.22}};
    const BoardLoad load = LoadBoard(board, foot);
    EXPECT_FALSE(load.outside);
    EXPECT_NEAR(Sum(load.corners_n), 400, 1e-9);
    EXPECT_NEAR((Cop(board, load.corners_n) - foot.cop_m).norm(), 0, 1e-9);
  }
}

TEST(LoadBoard, FrontOfABoardThatIsNotTurnedIsAhead) {
  const BoardLoad load = LoadBoard({}, {100, {0.5 * 0.238, 0}});
  EXPECT_NEAR(load.corners_n[0], 50, 1e-9);  // Top left and right carry all.
  EXPECT_NEAR(load.corners_n[1], 50, 1e-9);
  EXPECT_GT(LoadBoard({}, {100, {0, 0.1}}).corners_n[0], 25);  // Left is left.
}

TEST(LoadBoard, NoCellPullsWhenTheFootIsBeyondTheSensors) {
  const BoardLoad load = LoadBoard({}, {400, {0.3, 0}});
  EXPECT_TRUE(load.outside);
  EXPECT_NEAR(Sum(load.corners_n), 400, 1e-9);
  for (const double corner : load.corners_n) EXPECT_GE(corner, 0);
}

TEST(OneFootEach, HasTheFrontEdgesFacingEachOtherAcrossTheGap) {
  const auto boards = OneFootEach(0.02);
  EXPECT_NEAR(boards[0].middle_m.y(), 0.168, 1e-12);
  EXPECT_NEAR(boards[1].middle_m.y(), -0.168, 1e-12);
  // Top left is the first sensor; seen from above, the left board's front is at its right.
  EXPECT_NEAR(SensorPlaces(boards[0])[0].y(), 0.168 - 0.5 * 0.238, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[0])[0].x(), 0.5 * 0.433, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[1])[0].y(), -0.168 + 0.5 * 0.238, 1e-9);
  EXPECT_NEAR(SensorPlaces(boards[1])[0].x(), -0.5 * 0.433, 1e-9);
}

TEST(CellErrors, AreNoneWhenNoneAreWanted) {
  CellErrors cells({});
  const Corners forces{100, 90, 80, 70};
  EXPECT_EQ(cells.Advance(forces, 0.016), forces);
}

TEST(CellErrors, HysteresisLagsByItsPlayInBothDirections) {
  CellErrorConfig config;
  config.hysteresis_n = 2;
  CellErrors cells(config);
  const auto read = [&](double n) { return cells.Advance({n, n, n, n}, 0.016)[0]; };
  EXPECT_NEAR(read(100), 100, 1e-9);
  EXPECT_NEAR(read(101), 100, 1e-9);  // Inside the play.
  EXPECT_NEAR(read(110), 108, 1e-9);  // Going up it reads less,
  EXPECT_NEAR(read(100), 102, 1e-9);  // going down more.
}

TEST(CellErrors, NoiseGainAndSlowErrorHaveTheirSpread) {
  CellErrorConfig config;
  config.noise_kg = 0.05;
  config.slow_force_n = 1.5;
  config.slow_time_s = 0.5;
  CellErrors cells(config);
  const Corners forces{92.5, 92.5, 92.5, 92.5};  // 370 N: the slow error is whole.
  double noise = 0, total = 0;
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const Corners read = cells.Advance(forces, 1 / 60.0);
    noise += std::pow(read[0] - read[1], 2) / 2;
    total += std::pow(Sum(read) - 370, 2);
  }
  const double white = KilogramsToNewtons(0.05);
  EXPECT_NEAR(std::sqrt(noise / kSamples), white, 0.02 * white);
  EXPECT_NEAR(total / kSamples, 4 * white * white + 1.5 * 1.5, 0.3);
  config.gain_spread = 0.01;
  double square = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    config.seed = seed;
    const CellErrors spread(config);
    for (const double gain : spread.gains()) square += std::pow(gain - 1, 2);
  }
  EXPECT_NEAR(std::sqrt(square / 2000), 0.01, 0.001);
}

}  // namespace
}  // namespace footing::virtual_sensors
