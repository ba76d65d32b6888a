#include "common/virtual/devices/balance_board.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/virtual/devices/wiimote.h"

namespace footing::virtual_devices {
namespace {

constexpr double kStandardGravity = 9.80665;
/// A cell's own kilogram: the host multiplies by 0.99908.
constexpr double kCellKilogramN = kStandardGravity * 0.99908;

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
    const double force_n = 17 * kCellKilogramN * static_cast<double>(point);
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
  const double force_n = 17 * kCellKilogramN;
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
  const double force_n = 51 * kCellKilogramN;
  const Report above = board.Sample({0, force_n, 0, 0}).value();
  const auto& points = board.points()[0];
  EXPECT_EQ(CountsOf(above, 0), 2 * points[2] - points[1]);
  const Report below = board.Sample({0, -17 * kCellKilogramN, 0, 0}).value();
  EXPECT_EQ(CountsOf(below, 0), 2 * points[0] - points[1]);
}

TEST(BalanceBoard, ARealPacketIsReproduced) {
  // wiiuse issue 42; the loads are those that a calibration of 0x1000, 0x1600, 0x1c00 gives.
  constexpr BalanceBoard::Points kPoints = {0x1000, 0x1600, 0x1c00};
  BalanceBoard board(1, {kPoints, kPoints, kPoints, kPoints});
  Initialise(board);
  board.set_temperature(0x19);
  board.set_battery(0x6e);
  const auto force_n = [](int counts) { return (counts - 0x1000) * 17.0 / 0x600 * kCellKilogramN; };
  CornerForces forces;
  forces.top_right_n = force_n(0x03d0);
  forces.bottom_right_n = force_n(0x191a);
  forces.top_left_n = force_n(0x0017);
  forces.bottom_left_n = force_n(0x1523);
  Report real = {0x34, 0x00, 0x00, 0x03, 0xd0, 0x19, 0x1a, 0x00,
                 0x17, 0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  real.resize(22, 0);
  EXPECT_EQ(board.Sample(forces).value(), real);
}

TEST(BalanceBoard, ARealStatusReportIsReproduced) {
  BalanceBoard board(1);  // takeru/Wiimote issue 2.
  board.controller().set_battery(0xd5);
  EXPECT_EQ(board.HandleOutput(Report{0x15, 0x00}).at(0),
            (Report{0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0xd5}));
}

TEST(BalanceBoard, AWarmBoardReadsMore) {
  BalanceBoard board(4);
  Initialise(board);
  const double force_n = 10 * kCellKilogramN;
  const auto above_zero = [&] {
    return CountsOf(board.Sample({0, force_n, 0, 0}).value(), 0) - board.points()[0][0];
  };
  const int cool = above_zero();
  board.set_temperature(0x19 + 20);
  EXPECT_NEAR(above_zero(), cool / (1 - 0.007 * 20 / 10), 1);
}

TEST(Serial, DevicesOfOneSeedDifferByTheirKind) {
  const std::string board = BalanceBoard(7).identity().serial;
  const std::string wiimote = Wiimote(7).identity().serial;
  EXPECT_EQ(board.substr(0, 3), "56:");
  EXPECT_EQ(wiimote.substr(0, 3), "52:");
  EXPECT_NE(board, BalanceBoard(8).identity().serial);
}

}  // namespace
}  // namespace footing::virtual_devices
