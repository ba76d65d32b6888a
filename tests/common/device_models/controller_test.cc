#include "common/device_models/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace footing::device_models {
namespace {

Controller Plain() { return Controller(Memory(false)); }

Report ReadRequest(bool registers, std::uint32_t address, std::uint16_t size) {
  return {0x17,
          static_cast<std::uint8_t>(registers ? 4 : 0),
          static_cast<std::uint8_t>(address >> 16),
          static_cast<std::uint8_t>(address >> 8),
          static_cast<std::uint8_t>(address),
          static_cast<std::uint8_t>(size >> 8),
          static_cast<std::uint8_t>(size)};
}

Report WriteRequest(bool registers, std::uint32_t address, std::vector<std::uint8_t> data) {
  Report report = ReadRequest(registers, address, 0);
  report[0] = 0x16;
  report[5] = static_cast<std::uint8_t>(data.size());
  report.resize(6);
  report.insert(report.end(), data.begin(), data.end());
  report.resize(22, 0);
  return report;
}

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
  const std::pair<std::uint8_t, std::size_t> kSizes[] = {{0x30, 3},  {0x31, 6},  {0x32, 11},
                                                         {0x33, 18}, {0x34, 22}, {0x35, 22},
                                                         {0x36, 22}, {0x37, 22}, {0x3d, 22}};
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

}  // namespace
}  // namespace footing::device_models
