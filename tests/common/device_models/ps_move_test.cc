#include "common/device_models/ps_move.h"

#include <gtest/gtest.h>

namespace footing::device_models {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(PsMove, TheSphereGoesOutUnlessItsReportIsRepeated) {
  PsMove move(1, MoveModel::kZcm1);
  EXPECT_EQ(move.sphere_rgb(0), 0u);
  const Report lights = {0x06, 0x00, 0xff, 0x80, 0x10, 0x00, 0x60, 0x00, 0x00};
  move.HandleOutput(1 * kSecond, lights);
  EXPECT_EQ(move.sphere_rgb(5 * kSecond), 0xff8010u);
  EXPECT_EQ(move.rumble(5 * kSecond), 0x60);
  EXPECT_EQ(move.sphere_rgb(7 * kSecond), 0u);
  EXPECT_EQ(move.rumble(7 * kSecond), 0);
  move.HandleOutput(8 * kSecond, lights);
  EXPECT_EQ(move.sphere_rgb(9 * kSecond), 0xff8010u);
}

TEST(PsMove, ItsCalibrationComesInPiecesInTurn) {
  for (const auto& [model, pieces] : {std::pair{MoveModel::kZcm1, 3}, {MoveModel::kZcm2, 2}}) {
    PsMove move(2, model);
    for (int i = 0; i < 2 * pieces; ++i) {
      const auto piece = move.Feature(0x10, 49);
      ASSERT_TRUE(piece);
      EXPECT_EQ((*piece)[0], 0x10);
      const int number = i % pieces;
      EXPECT_EQ((*piece)[1], number | (number == pieces - 1 ? 0x80 : 0));
    }
    EXPECT_FALSE(move.Feature(0x10, 20));
    EXPECT_FALSE(move.Feature(0x04, 49));
  }
}

TEST(PsMove, ReportsAreCountedAndHaveTheLengthOfTheModel) {
  PsMove first(3, MoveModel::kZcm1), second(3, MoveModel::kZcm2);
  for (int i = 0; i < 20; ++i) {
    const Report report = first.Sample(i * 11'000'000, MoveSensors()).at(0);
    EXPECT_EQ(report.size(), 49u);
    EXPECT_EQ(report[4] & 0x0f, i % 16);
  }
  EXPECT_EQ(second.Sample(0, MoveSensors()).at(0).size(), 44u);
  EXPECT_EQ(second.identity().product, 0x0c5eu);
}

}  // namespace
}  // namespace footing::device_models
