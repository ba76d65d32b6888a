#include "common/device_models/balance_board.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace footing::device_models {
namespace {

constexpr double kStandardGravity = 9.80665;
/// The load that reads as 1 kg of calibration at the reference temperature (WiiBrew).
constexpr double kKilogram = 0.99908 * kStandardGravity;

Report Write(std::uint32_t address, std::uint8_t byte) {
  Report report(22, 0);
  report[0] = 0x16;
  report[1] = 0x04;
  report[2] = static_cast<std::uint8_t>(address >> 16);
  report[3] = static_cast<std::uint8_t>(address >> 8);
  report[4] = static_cast<std::uint8_t>(address);
  report[5] = 1;
  report[6] = byte;
  return report;
}

void Initialise(BalanceBoard& board) {
  EXPECT_EQ(board.HandleOutput(Write(0xa400f0, 0x55)).at(0)[4], 0);
  EXPECT_EQ(board.HandleOutput(Write(0xa400fb, 0x00)).at(0)[4], 0);
  board.HandleOutput(Report{0x12, 0x04, 0x34});
}

Report ReadIdentity(BalanceBoard& board) {
  return board.HandleOutput(Report{0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06}).at(0);
}

int CountsOf(const Report& report, std::size_t corner) {
  return report[3 + 2 * corner] << 8 | report[4 + 2 * corner];
}

TEST(BalanceBoard, ItsStatusShowsAnExtension) {
  BalanceBoard board(1);
  EXPECT_EQ(board.HandleOutput(Report{0x15, 0x00}).at(0)[3] & 0x02, 0x02);
}

TEST(BalanceBoard, ItsIdentityIsReadableOnlyAfterTheKey) {
  BalanceBoard board(1);
  EXPECT_EQ(ReadIdentity(board)[8], 0xff);
  Initialise(board);
  const Report reply = ReadIdentity(board);
  EXPECT_EQ(std::vector<std::uint8_t>(reply.begin() + 6, reply.begin() + 12),
            (std::vector<std::uint8_t>{0x00, 0x00, 0xa4, 0x20, 0x04, 0x02}));
}

TEST(BalanceBoard, ItsCalibrationHasARightChecksum) {
  BalanceBoard board(9);
  const auto page = board.controller().memory().extension();
  uLong crc = crc32(0, page.data() + 0x24, 24);
  crc = crc32(crc, page.data() + 0x20, 2);
  crc = crc32(crc, page.data() + 0x60, 2);
  const std::uint32_t stored = std::uint32_t{page[0x3c]} << 24 | std::uint32_t{page[0x3d]} << 16 |
                               std::uint32_t{page[0x3e]} << 8 | page[0x3f];
  EXPECT_EQ(stored, crc);
}

TEST(BalanceBoard, ReportsItsOwnCountsAtTheCalibrationPoints) {
  BalanceBoard board(4);
  Initialise(board);
  for (std::size_t point = 0; point < 3; ++point) {
    const double force_n = 17 * kKilogram * static_cast<double>(point);
    const Report report = board.Sample({force_n, force_n, force_n, force_n}).value();
    ASSERT_EQ(report[0], 0x34);
    for (std::size_t corner = 0; corner < 4; ++corner) {
      EXPECT_EQ(CountsOf(report, corner), board.points()[corner][point]);
    }
  }
}

TEST(BalanceBoard, EachCornerHasItsPlaceInTheReport) {
  BalanceBoard board(4);
  Initialise(board);
  const double force_n = 17 * kKilogram;
  const CornerForces kOne[] = {{0, force_n, 0, 0},
                               {0, 0, 0, force_n},
                               {force_n, 0, 0, 0},
                               {0, 0, force_n, 0}};  // Top right, bottom right, top left, ...
  for (std::size_t loaded = 0; loaded < 4; ++loaded) {
    const Report report = board.Sample(kOne[loaded]).value();
    for (std::size_t corner = 0; corner < 4; ++corner) {
      EXPECT_EQ(CountsOf(report, corner), board.points()[corner][corner == loaded ? 1 : 0]);
    }
  }
}

TEST(BalanceBoard, GoesOnBelowZeroAndAboveItsLastPoint) {
  BalanceBoard board(4);
  Initialise(board);
  const double force_n = 51 * kKilogram;
  const Report above = board.Sample({0, force_n, 0, 0}).value();
  const auto& points = board.points()[0];
  EXPECT_EQ(CountsOf(above, 0), 2 * points[2] - points[1]);
  const Report below = board.Sample({0, -17 * kKilogram, 0, 0}).value();
  EXPECT_EQ(CountsOf(below, 0), 2 * points[0] - points[1]);
}

TEST(BalanceBoard, AWarmBoardReadsTooMuchAndSaysItsTemperature) {
  BalanceBoard board(4);
  Initialise(board);
  const double force_n = 17 * kKilogram;
  const int cold = CountsOf(board.Sample({0, force_n, 0, 0}).value(), 0) - board.points()[0][0];
  board.set_temperature(BalanceBoard::kReferenceTemperature + 10);
  board.set_battery(0x70);
  const Report report = board.Sample({0, force_n, 0, 0}).value();
  const int warm = CountsOf(report, 0) - board.points()[0][0];
  EXPECT_NEAR(warm, cold / (1 - 0.007), 2);
  EXPECT_EQ(report[11], BalanceBoard::kReferenceTemperature + 10);
  EXPECT_EQ(report[13], 0x70);
}

TEST(BalanceBoard, AtThePoleItReadsMoreThanAtTheEquator) {
  BalanceBoard board(4);
  Initialise(board);
  const auto count_at = [&board](double gravity_mps2) {
    board.set_gravity(gravity_mps2);
    return CountsOf(board.Sample({0, 30 * kKilogram, 0, 0}).value(), 0) - board.points()[0][0];
  };
  EXPECT_NEAR(count_at(9.832) - count_at(9.780), 0.0053 * count_at(9.80665), 4);
}

}  // namespace
}  // namespace footing::device_models
