#include <algorithm>
#include <array>
#include <random>

#include <gtest/gtest.h>
#include <zlib.h>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/extensions.h"
#include "common/virtual/devices/wiimote.h"
#include "tests/common/virtual/devices/requests.h"

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

Controller Plain() { return Controller(Memory(false)); }

TEST(Controller, AnyReadWithinTheEepromComesInPiecesOfSixteen) {
  Controller device = Plain();
  for (std::size_t i = 0; i < device.memory().eeprom().size(); ++i) {
    device.memory().eeprom()[i] = static_cast<std::uint8_t>(i * 7 + i / 256);
  }
  std::mt19937 random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    const std::uint32_t address = random() % 0x1700;
    const auto size = static_cast<std::uint16_t>(1 + random() % (0x1700 - address));
    std::vector<std::uint8_t> got;
    for (const Report& piece : device.HandleOutput(ReadRequest(false, address, size))) {
      ASSERT_EQ(piece.size(), 22u);
      ASSERT_EQ(piece[0], 0x21);
      ASSERT_EQ(piece[3] & 0x0f, 0);
      const std::size_t offset = piece[4] << 8 | piece[5];
      ASSERT_EQ(offset, address + got.size());
      const std::size_t count = (piece[3] >> 4) + 1u;
      got.insert(got.end(), piece.begin() + 6, piece.begin() + 6 + static_cast<long>(count));
    }
    ASSERT_EQ(got.size(), size);
    EXPECT_TRUE(std::equal(got.begin(), got.end(), device.memory().eeprom().begin() + address));
  }
}

TEST(Controller, ReadsOfWrongAddressesEndWithTheirError) {
  Controller device = Plain();
  const struct {
    bool registers;
    std::uint32_t address;
    std::uint16_t size;
    std::size_t good_pieces;
    std::uint8_t error;
  } kReads[] = {
      {false, 0x1700, 1, 0, 8},                                 // Just past the EEPROM.
      {false, 0x1770, 16, 0, 8},   {false, 0x16f0, 32, 1, 8},   // Crosses its end.
      {false, 0xffffff, 16, 0, 8}, {true, 0xa400fa, 6, 0, 7},   // Nothing plugged in.
      {true, 0xa600fa, 6, 0, 7},                                // No MotionPlus.
      {true, 0x120000, 16, 0, 7},  {true, 0xa200f8, 16, 0, 7},  // Crosses the page.
  };
  for (const auto& read : kReads) {
    const auto pieces = device.HandleOutput(ReadRequest(read.registers, read.address, read.size));
    ASSERT_EQ(pieces.size(), read.good_pieces + 1) << read.address;
    EXPECT_EQ(pieces.back()[3], 0xf0 | read.error) << read.address;
    EXPECT_TRUE(std::all_of(pieces.back().begin() + 6, pieces.back().end(),
                            [](std::uint8_t byte) { return byte == 0; }));
  }
}

TEST(Controller, WritesAreAcknowledgedWithTheirError) {
  Controller device = Plain();
  EXPECT_EQ(device.HandleOutput(WriteRequest(false, 0x100, {1, 2, 3})).at(0),
            (Report{0x22, 0, 0, 0x16, 0}));
  EXPECT_EQ(device.memory().eeprom()[0x102], 3);
  EXPECT_EQ(device.HandleOutput(WriteRequest(false, 0x16ff, {1, 2})).at(0)[4], 8);
  EXPECT_EQ(device.HandleOutput(WriteRequest(true, 0xa400f0, {0x55})).at(0)[4], 7);
  Report too_long = WriteRequest(false, 0, {1});
  too_long[5] = 17;
  EXPECT_EQ(device.HandleOutput(too_long).at(0)[4], 8);
}

TEST(Controller, AnswersAStatusRequest) {
  Controller device = Plain();
  device.set_battery(0x60);
  device.HandleOutput(Report{0x11, 0x50});
  EXPECT_EQ(device.HandleOutput(Report{0x15, 0x00}).at(0), (Report{0x20, 0, 0, 0x50, 0, 0, 0x60}));
}

TEST(Controller, ContinuousModeReportsEverySampleOtherModesOnlyChanges) {
  Controller device = Plain();
  EXPECT_FALSE(device.DataReport({}));
  EXPECT_EQ(device.HandleOutput(Report{0x12, 0x04, 0x31}).at(0), (Report{0x22, 0, 0, 0x12, 0}));
  EXPECT_TRUE(device.DataReport({}));
  EXPECT_TRUE(device.DataReport({}));
  device.HandleOutput(Report{0x12, 0x00, 0x31});
  EXPECT_TRUE(device.DataReport({}));
  EXPECT_FALSE(device.DataReport({}));
  Readings pressed;
  pressed.buttons = 0x0008;
  EXPECT_TRUE(device.DataReport(pressed));
}

TEST(Controller, AnUnknownModeIsRefusedAndTheOldOneStays) {
  Controller device = Plain();
  device.HandleOutput(Report{0x12, 0x04, 0x31});
  EXPECT_NE(device.HandleOutput(Report{0x12, 0x04, 0x39}).at(0)[4], 0);
  EXPECT_EQ(device.mode(), 0x31);
}

TEST(Controller, AfterAnUnaskedStatusNoDataComeUntilTheModeIsSet) {
  Controller device = Plain();
  device.HandleOutput(Report{0x12, 0x04, 0x31});
  EXPECT_EQ(device.UnaskedStatus()[0], 0x20);
  EXPECT_FALSE(device.DataReport({}));
  device.HandleOutput(Report{0x12, 0x04, 0x31});
  EXPECT_TRUE(device.DataReport({}));
}

TEST(Controller, TheMotorRunsOnlyWhileEveryReportSaysSo) {
  Controller device = Plain();
  device.HandleOutput(Report{0x10, 0x01});
  EXPECT_TRUE(device.rumble());
  device.HandleOutput(Report{0x11, 0x11});
  EXPECT_TRUE(device.rumble());
  device.HandleOutput(Report{0x15, 0x00});
  EXPECT_FALSE(device.rumble());
}

TEST(Controller, AnAcknowledgementIsSentWhenAskedFor) {
  Controller device = Plain();
  EXPECT_TRUE(device.HandleOutput(Report{0x11, 0x10}).empty());
  EXPECT_EQ(device.HandleOutput(Report{0x11, 0x12}).at(0), (Report{0x22, 0, 0, 0x11, 0}));
}

TEST(Controller, EveryModeHasItsLength) {
  const std::pair<std::uint8_t, std::size_t> kSizes[] = {
      {0x30, 3},  {0x31, 6},  {0x32, 11}, {0x33, 18}, {0x34, 22},
      {0x35, 22}, {0x36, 22}, {0x37, 22}, {0x3d, 22}, {0x3e, 22}};
  Controller device = Plain();
  for (const auto& [mode, size] : kSizes) {
    device.HandleOutput(Report{0x12, 0x04, mode});
    const auto report = device.DataReport({});
    ASSERT_TRUE(report);
    EXPECT_EQ(report->size(), size) << int{mode};
    EXPECT_EQ(report->at(0), mode);
  }
}

TEST(Controller, RubbishIsNotAnsweredAndBreaksNothing) {
  Controller device = Plain();
  std::mt19937 random(5);
  for (int trial = 0; trial < 50'000; ++trial) {
    Report report(random() % 24);
    for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
    if (!report.empty() && trial % 2 == 0) {
      report[0] = static_cast<std::uint8_t>(0x10 + random() % 12);
    }
    for (const Report& answer : device.HandleOutput(report)) {
      ASSERT_GE(answer[0], 0x20);
      ASSERT_LE(answer[0], 0x22);
      ASSERT_LE(answer.size(), 22u);
    }
  }
}

/// Switches the camera on, in the format that belongs to the mode.
void StartCamera(Controller& device, std::uint8_t format) {
  device.HandleOutput(Report{0x13, 0x04});
  device.HandleOutput(Report{0x1a, 0x04});
  device.HandleOutput(WriteRequest(true, 0xb00030, {0x08}));
  device.HandleOutput(WriteRequest(true, 0xb00033, {format}));
}

TEST(Controller, ACameraThatIsOffOrOfAnotherFormatSeesNothing) {
  Controller device = Plain();
  Readings readings;
  readings.camera[0] = CameraPoint{100, 200, 3};
  device.HandleOutput(Report{0x12, 0x04, 0x33});
  const auto all_ff = [](const Report& report) {
    return std::all_of(report.begin() + 6, report.end(), [](std::uint8_t b) { return b == 0xff; });
  };
  EXPECT_TRUE(all_ff(device.DataReport(readings).value()));
  StartCamera(device, 1);
  EXPECT_TRUE(all_ff(device.DataReport(readings).value()));
  StartCamera(device, 3);
  EXPECT_FALSE(all_ff(device.DataReport(readings).value()));
  device.HandleOutput(Report{0x13, 0x00});
  EXPECT_TRUE(all_ff(device.DataReport(readings).value()));
}

TEST(Controller, TheStatusShowsCameraAndSpeaker) {
  Controller device = Plain();
  EXPECT_EQ(device.HandleOutput(Report{0x15, 0x00}).at(0)[3], 0x00);
  StartCamera(device, 1);
  device.HandleOutput(Report{0x14, 0x04});
  EXPECT_EQ(device.HandleOutput(Report{0x15, 0x00}).at(0)[3], 0x0c);
}

TEST(Controller, CameraPointsAreLaidOutByTheirFormat) {
  Controller device = Plain();
  Readings readings;
  readings.camera[0] = CameraPoint{0x3a5, 0x2c7, 4};
  readings.camera[1] = CameraPoint{0x112, 0x1f0, 9};
  // Extended: x, y, then y bits 9 and 8, x bits 9 and 8, size.
  device.HandleOutput(Report{0x12, 0x04, 0x33});
  StartCamera(device, 3);
  const Report extended = device.DataReport(readings).value();
  EXPECT_EQ(Report(extended.begin() + 6, extended.begin() + 12),
            (Report{0xa5, 0xc7, 0xb4, 0x12, 0xf0, 0x59}));
  // Basic: x1, y1, then y1 x1 y2 x2 bits 9 and 8, x2, y2.
  device.HandleOutput(Report{0x12, 0x04, 0x37});
  StartCamera(device, 1);
  const Report basic = device.DataReport(readings).value();
  EXPECT_EQ(Report(basic.begin() + 6, basic.begin() + 11), (Report{0xa5, 0xc7, 0xb5, 0x12, 0xf0}));
}

TEST(Controller, InterleavedReportsCarryOneMomentInTwoHalves) {
  Controller device = Plain();
  Readings first;
  first.buttons = 0x0808;
  first.acceleration_counts = {0xa5 << 2, 0x5a << 2, 0xc6 << 2};
  device.HandleOutput(Report{0x12, 0x04, 0x3e});
  const Report x = device.DataReport(first).value();
  const Report y = device.DataReport({}).value();
  // z = 0xc6: bits 5 and 4 in 3e's first button byte, 7 and 6 in its second; 1 and 0, 3 and 2 in
  // 3f.
  EXPECT_EQ(Report(x.begin(), x.begin() + 4), (Report{0x3e, 0x08 | 0 << 5, 0x08 | 3 << 5, 0xa5}));
  EXPECT_EQ(Report(y.begin(), y.begin() + 4), (Report{0x3f, 2 << 5, 1 << 5, 0x5a}));
  EXPECT_EQ(device.DataReport(first).value()[0], 0x3e);
}

std::array<std::uint8_t, 6> IdentityAt(const Memory& memory, std::uint32_t page,
                                       std::uint8_t* error = nullptr) {
  std::array<std::uint8_t, 6> bytes{};
  const std::uint8_t result = memory.Read(true, page + 0xfa, bytes);
  if (error != nullptr) *error = result;
  return bytes;
}

std::uint8_t Write(Memory& memory, std::uint32_t address, std::uint8_t value) {
  return memory.Write(true, address, {{value}});
}

void Key(Memory& memory) {
  EXPECT_EQ(Write(memory, 0xa400f0, 0x55), kMemoryOk);
  EXPECT_EQ(Write(memory, 0xa400fb, 0x00), kMemoryOk);
}

TEST(Memory, AnExtensionReadsAsFfUntilTheKeyIsWritten) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  EXPECT_TRUE(memory.has_extension());
  EXPECT_EQ(IdentityAt(memory, 0xa40000)[2], 0xff);
  Key(memory);
  EXPECT_EQ(IdentityAt(memory, 0xa40000),
            (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}));
}

TEST(Memory, AMotionPlusMovesToTheExtensionsPageAndBack) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  EXPECT_EQ(IdentityAt(memory, 0xa60000),
            (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}));
  for (const std::uint8_t mode : {4, 5, 7}) {
    EXPECT_EQ(Write(memory, 0xa600fe, mode), kMemoryOk);
    EXPECT_EQ(memory.motion_plus_mode(), mode);
    EXPECT_EQ(IdentityAt(memory, 0xa40000),
              (std::array<std::uint8_t, 6>{0x00, 0x00, 0xa4, 0x20, mode, 0x05}));
    std::uint8_t error = 0;
    IdentityAt(memory, 0xa60000, &error);
    EXPECT_EQ(error, kMemoryAbsent);
    Key(memory);  // Ends it, and begins the child's initialisation.
    EXPECT_EQ(memory.motion_plus_mode(), 0);
    EXPECT_EQ(IdentityAt(memory, 0xa40000)[4], 0x00);
    EXPECT_TRUE(memory.extension_plain());
    EXPECT_EQ(IdentityAt(memory, 0xa60000)[2], 0xa6);
  }
}

TEST(Memory, AMotionPlusIgnoresModesThatItDoesNotHave) {
  Memory memory(false);
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), true));
  for (const std::uint8_t mode : {0, 3, 6, 8, 0xff}) Write(memory, 0xa600fe, mode);
  EXPECT_EQ(memory.motion_plus_mode(), 0);
  EXPECT_FALSE(memory.has_extension());  // Inactive, it does not show in the port.
  EXPECT_EQ(IdentityAt(memory, 0xa60000)[0], 0x01);
}

TEST(Memory, AnActiveMotionPlusKeepsACopyOfTheNunchuksBlock) {
  Memory memory(false);
  const NunchukBlock block = DrawNunchukBlock(8);
  memory.SetExtension(NunchukPage(block));
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  Write(memory, 0xa600fe, 5);
  NunchukBlock copy{};
  EXPECT_EQ(memory.Read(true, 0xa40040, copy), kMemoryOk);
  EXPECT_EQ(copy, block);
}

TEST(Memory, APortThatIsNotReadyAnswersNothing) {
  Memory memory(true);
  memory.SetMotionPlus(MotionPlusPage(DrawMotionPlusBlock(2), false));
  memory.set_port_ready(false);
  EXPECT_FALSE(memory.has_extension());
  EXPECT_EQ(Write(memory, 0xa400f0, 0x55), kMemoryAbsent);
  EXPECT_EQ(Write(memory, 0xa600fe, 4), kMemoryAbsent);
  memory.set_port_ready(true);
  EXPECT_TRUE(memory.has_extension());
}

TEST(Memory, CalibrationsAndIdentitiesCannotBeOverwritten) {
  Memory memory(false);
  memory.SetExtension(NunchukPage(DrawNunchukBlock(1)));
  Key(memory);
  const auto before = IdentityAt(memory, 0xa40000);
  Write(memory, 0xa400fa, 0x77);
  EXPECT_EQ(memory.Write(true, 0xa40020, {{1, 2, 3}}), kMemoryOk);
  EXPECT_EQ(IdentityAt(memory, 0xa40000), before);
  NunchukBlock block{};
  EXPECT_EQ(memory.Read(true, 0xa40020, block), kMemoryOk);
  EXPECT_EQ(block, DrawNunchukBlock(1));
}

}  // namespace
}  // namespace footing::virtual_devices
