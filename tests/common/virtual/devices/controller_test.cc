#include "common/virtual/devices/controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/common/virtual/devices/requests.h"

namespace footing::virtual_devices {
namespace {

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

}  // namespace
}  // namespace footing::virtual_devices
