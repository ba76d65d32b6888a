#include "daemon/sensor/reports/input_report.h"

#include <gtest/gtest.h>

#include <vector>

namespace footing::reports {
namespace {

using Report = std::vector<std::uint8_t>;

template <typename Body>
Body DecodeAs(const Report& report) {
  const InputReport decoded = Decode(report);
  const Body* body = std::get_if<Body>(&decoded.body);
  EXPECT_NE(body, nullptr);
  return body == nullptr ? Body{} : *body;
}

bool IsUndecodable(const Report& report) {
  return std::holds_alternative<Undecodable>(Decode(report).body);
}

TEST(InputReport, AccelerationHasTenBitsInXAndNineInYAndZ) {
  // Bits 6 and 5 of the first button byte are x1 and x0; bit 5 of the second is y1, bit 6 is z1.
  const auto none = DecodeAs<Data>({0x31, 0x00, 0x00, 0x80, 0x81, 0x9a});
  EXPECT_TRUE(none.has_acceleration);
  EXPECT_EQ(none.acceleration_counts, (std::array<std::uint16_t, 3>{0x200, 0x204, 0x268}));
  const auto x = DecodeAs<Data>({0x31, 0x60, 0x00, 0x80, 0x81, 0x9a});
  EXPECT_EQ(x.acceleration_counts, (std::array<std::uint16_t, 3>{0x203, 0x204, 0x268}));
  const auto y = DecodeAs<Data>({0x31, 0x00, 0x20, 0x80, 0x81, 0x9a});
  EXPECT_EQ(y.acceleration_counts, (std::array<std::uint16_t, 3>{0x200, 0x206, 0x268}));
  const auto z = DecodeAs<Data>({0x31, 0x00, 0x40, 0x80, 0x81, 0x9a});
  EXPECT_EQ(z.acceleration_counts, (std::array<std::uint16_t, 3>{0x200, 0x204, 0x26a}));
}

TEST(InputReport, AccelerationBitsAreNoButtons) {
  const InputReport decoded = Decode(Report{0x31, 0x60, 0x60, 0x80, 0x80, 0x9a});
  EXPECT_TRUE(decoded.has_buttons);
  EXPECT_EQ(decoded.buttons, 0);
}

TEST(InputReport, EveryButtonHasItsBit) {
  const std::pair<Report, std::uint16_t> kButtons[] = {
      {{0x30, 0x01, 0x00}, kLeft},  {{0x30, 0x02, 0x00}, kRight}, {{0x30, 0x04, 0x00}, kDown},
      {{0x30, 0x08, 0x00}, kUp},    {{0x30, 0x10, 0x00}, kPlus},  {{0x30, 0x00, 0x01}, kTwo},
      {{0x30, 0x00, 0x02}, kOne},   {{0x30, 0x00, 0x04}, kB},     {{0x30, 0x00, 0x08}, kA},
      {{0x30, 0x00, 0x10}, kMinus}, {{0x30, 0x00, 0x80}, kHome}};
  for (const auto& [report, button] : kButtons) EXPECT_EQ(Decode(report).buttons, button);
}

TEST(InputReport, ButtonsOfStatusMemoryAndAcknowledgementCount) {
  Report memory(22, 0);
  memory[0] = 0x21;
  memory[2] = 0x08;
  EXPECT_EQ(Decode(memory).buttons, kA);
  EXPECT_EQ(Decode(Report{0x20, 0, 0x08, 0, 0, 0, 0xc0}).buttons, kA);
  EXPECT_EQ(Decode(Report{0x22, 0, 0x08, 0x16, 0}).buttons, kA);
}

TEST(InputReport, StatusOfARealBoard) {
  // As logged over the air: A1 20 00 00 02 00 00 D5.
  const auto status = DecodeAs<Status>({0x20, 0x00, 0x00, 0x02, 0x00, 0x00, 0xd5});
  EXPECT_TRUE(status.extension);
  EXPECT_FALSE(status.battery_low);
  EXPECT_EQ(status.leds, 0);
  EXPECT_EQ(status.battery, 0xd5);
}

TEST(InputReport, StatusFlagsAndLeds) {
  const auto status = DecodeAs<Status>({0x20, 0, 0, 0xad, 0, 0, 0x20});
  EXPECT_TRUE(status.battery_low);
  EXPECT_FALSE(status.extension);
  EXPECT_TRUE(status.speaker);
  EXPECT_TRUE(status.ir_camera);
  EXPECT_EQ(status.leds, 0x0a);
}

TEST(InputReport, MemoryDataGivesSizeErrorAndOffset) {
  Report report(22, 0xab);
  report[3] = 0x50;  // Six bytes, no error.
  report[4] = 0x00;
  report[5] = 0xfa;
  report[0] = 0x21;
  const auto memory = DecodeAs<MemoryData>(report);
  EXPECT_EQ(memory.size, 6);
  EXPECT_EQ(memory.error, 0);
  EXPECT_EQ(memory.offset, 0x00fa);
  EXPECT_EQ(memory.data[5], 0xab);
  report[3] = 0xf8;
  EXPECT_EQ(DecodeAs<MemoryData>(report).error, 8);
}

TEST(InputReport, AcknowledgementOfARefusedStatusRequest) {
  const auto acknowledgement = DecodeAs<Acknowledgement>({0x22, 0x00, 0x00, 0x15, 0x02});
  EXPECT_EQ(acknowledgement.report, 0x15);
  EXPECT_EQ(acknowledgement.error, 2);
}

TEST(InputReport, EachModeHasItsExtensionBytes) {
  const struct {
    std::uint8_t id;
    std::size_t first;
    std::uint8_t size;
  } kModes[] = {{0x32, 3, 8},  {0x34, 3, 19}, {0x35, 6, 16},
                {0x36, 13, 9}, {0x37, 16, 6}, {0x3d, 1, 21}};
  for (const auto& mode : kModes) {
    Report report(22);
    for (std::size_t i = 0; i < report.size(); ++i) report[i] = static_cast<std::uint8_t>(i);
    report[0] = mode.id;
    const auto data = DecodeAs<Data>(report);
    ASSERT_EQ(data.extension_size, mode.size) << int{mode.id};
    EXPECT_EQ(data.extension()[0], mode.first) << int{mode.id};
    EXPECT_EQ(data.extension().back(), mode.first + mode.size - 1u) << int{mode.id};
  }
}

TEST(InputReport, ShortFormsHoldButtonsAlone) {
  for (std::uint8_t id = 0x31; id <= 0x37; ++id) {
    const InputReport decoded = Decode(Report{id, 0x00, 0x08});
    EXPECT_EQ(decoded.buttons, kA);
    const Data* data = std::get_if<Data>(&decoded.body);
    ASSERT_NE(data, nullptr) << int{id};
    EXPECT_FALSE(data->has_acceleration);
    EXPECT_EQ(data->extension_size, 0);
  }
}

TEST(InputReport, TheInterleavedPairGivesItsButtonsOnly) {
  for (const std::uint8_t id : {0x3e, 0x3f}) {
    Report report(22, 0xff);
    report[0] = id;
    report[1] = 0x00;
    report[2] = 0x08;
    EXPECT_EQ(Decode(report).buttons, kA);
    EXPECT_FALSE(DecodeAs<Data>(report).has_acceleration);
  }
}

TEST(InputReport, WhatMakesNoSenseIsNamed) {
  EXPECT_TRUE(IsUndecodable({}));
  EXPECT_TRUE(IsUndecodable({0x31}));
  EXPECT_TRUE(IsUndecodable({0x31, 0x00}));
  EXPECT_TRUE(IsUndecodable(Report(23, 0x31)));
  EXPECT_TRUE(IsUndecodable({0x00, 0x00, 0x00}));
  EXPECT_TRUE(IsUndecodable({0x38, 0x00, 0x00}));
  EXPECT_TRUE(IsUndecodable({0x20, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(IsUndecodable({0x22, 0, 0, 0x16}));
  // Says 16 bytes, holds 15.
  Report memory(21, 0);
  memory[0] = 0x21;
  memory[3] = 0xf0;
  EXPECT_TRUE(IsUndecodable(memory));
}

TEST(InputReport, NoTruncationReadsPastTheEnd) {
  // Under AddressSanitizer an overrun of the exact-size copy ends the test.
  for (int id = 0; id < 256; ++id) {
    for (std::size_t size = 1; size <= 22; ++size) {
      Report report(size, 0xff);
      report[0] = static_cast<std::uint8_t>(id);
      report.shrink_to_fit();
      const InputReport decoded = Decode(report);
      if (const auto* data = std::get_if<Data>(&decoded.body)) {
        EXPECT_LE(data->extension_size + (decoded.has_buttons ? 3u : 1u), size);
      }
    }
  }
}

TEST(InputReport, BatteryIsBetweenEmptyAndFull) {
  EXPECT_DOUBLE_EQ(BatteryFraction(0), 0);
  EXPECT_DOUBLE_EQ(BatteryFraction(0x3e), 0.5);  // 0x3e / 0x7c
  EXPECT_DOUBLE_EQ(BatteryFraction(0xd5), 1);
}

}  // namespace
}  // namespace footing::reports
