#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/sensor/reports/input_report.h"
#include "daemon/sensor/reports/output_report.h"

namespace footing::reports {
namespace {

using Block = std::vector<std::uint8_t>;

void ExpectPoint(const stream::CameraPoint& point, unsigned x, unsigned y, unsigned size) {
  EXPECT_EQ(point.x, x);
  EXPECT_EQ(point.y, y);
  EXPECT_EQ(point.size, size);
}

TEST(Camera, BasicFormatHasTwoPointsInFiveBytes) {
  // (0x312, 0x234) and (0x145, 0x067): upper bits y1 2, x1 3, y2 0, x2 1.
  const Block first = {0x12, 0x34, 0b10'11'00'01, 0x45, 0x67};
  Block camera = first;
  camera.insert(camera.end(), 5, 0xff);
  const auto points = DecodeCamera(camera);
  ASSERT_EQ(points.size(), 2u);
  ExpectPoint(points[0], 0x312, 0x234, 0);
  ExpectPoint(points[1], 0x145, 0x067, 0);
}

TEST(Camera, ExtendedFormatHasSizes) {
  Block camera(12, 0xff);
  camera[3] = 0x12;
  camera[4] = 0x34;
  camera[5] = 0b10'11'0101;
  const auto points = DecodeCamera(camera);
  ASSERT_EQ(points.size(), 1u);
  ExpectPoint(points[0], 0x312, 0x234, 5);
}

TEST(Camera, FullFormatIsReadInHalvesAndWhole) {
  Block half = {0x12, 0x34, 0b10'11'0101, 1, 2, 3, 4, 0, 99};
  half.insert(half.end(), 9, 0xff);
  ASSERT_EQ(DecodeCamera(half).size(), 1u);
  ExpectPoint(DecodeCamera(half)[0], 0x312, 0x234, 5);
  Block whole = half;
  whole.insert(whole.end(), half.begin(), half.end());
  EXPECT_EQ(DecodeCamera(whole).size(), 2u);
}

TEST(Camera, SeesNothingWithoutPointsOrFormat) {
  for (const std::size_t size : {0u, 1u, 10u, 11u, 12u, 18u, 21u, 36u}) {
    EXPECT_TRUE(DecodeCamera(Block(size, 0xff)).empty()) << size;
  }
  EXPECT_TRUE(DecodeCamera(Block(11, 0x00)).empty());
}

TEST(Camera, ARowBelowThePictureIsNotSeen) {
  Block camera(12, 0xff);
  camera[0] = 0x00;
  camera[1] = 0x00;
  camera[2] = 0b11'00'0001;  // Row 768, the first below.
  EXPECT_TRUE(DecodeCamera(camera).empty());
  camera[1] = 0xff;
  camera[2] = 0b10'00'0001;  // Row 767, the last.
  EXPECT_EQ(DecodeCamera(camera).size(), 1u);
}

using Six = std::vector<std::uint8_t>;
using Axes = std::array<std::uint16_t, 3>;

TEST(Identity, EveryKindIsTold) {
  EXPECT_EQ(IdentifyExtension(Six{0x01, 0x00, 0xa4, 0x20, 0x01, 0x01}), Extension::kClassic);
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa6, 0x20, 0x00, 0x05}),
            Extension::kMotionPlusInactive);
  EXPECT_EQ(IdentifyExtension(Six{0x01, 0x00, 0xa6, 0x20, 0x04, 0x05}),
            Extension::kMotionPlusInactive)
      << "was active before";
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa4, 0x20, 0x04, 0x05}), Extension::kMotionPlus);
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa4, 0x20, 0x05, 0x05}),
            Extension::kMotionPlusNunchuk);
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa4, 0x20, 0x07, 0x05}),
            Extension::kMotionPlusClassic);
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa4, 0x20, 0x01, 0x03}), Extension::kOther);
  EXPECT_EQ(IdentifyExtension(Six{0x00, 0x00, 0xa6, 0x20, 0x00}), Extension::kNotReady);
}

TEST(Nunchuk, TakesBitsFromTheirPlaces) {
  // Low bits: z 01, y 10, x 11, C 0 (pressed), Z 1.
  const auto counts = DecodeNunchuk(Six{0x20, 0xe0, 0x80, 0x81, 0xb2, 0b01'10'11'0'1});
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->stick_x, 0x20);
  EXPECT_EQ(counts->stick_y, 0xe0);
  EXPECT_EQ(counts->acceleration, (Axes{0x203, 0x206, 0x2c9}));
  EXPECT_TRUE(counts->c);
  EXPECT_FALSE(counts->z);
}

TEST(Nunchuk, PassedByTheMotionPlusLosesOnlyTheLowestBits) {
  // The same as above: z = 0x2c9 = 1011001001, bits 9 to 3 in byte 4, 2 and 1 in byte 5.
  const auto z_upper = static_cast<std::uint8_t>((0x2c9 >> 3) << 1 | 1);
  const auto counts = DecodePassedNunchuk(Six{0x20, 0xe0, 0x80, 0x81, z_upper, 0b00'1'1'0'1'0'0});
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->acceleration, (Axes{0x202, 0x206, 0x2c8}));
  EXPECT_TRUE(counts->c);
  EXPECT_FALSE(counts->z);
}

TEST(Nunchuk, NoneFromTooFewBytesOrASilentPort) {
  EXPECT_FALSE(DecodeNunchuk(Six(5, 0x80)));
  EXPECT_FALSE(DecodeNunchuk(Six(6, 0xff)));
  EXPECT_FALSE(DecodePassedNunchuk(Six(5, 0x80)));
  EXPECT_FALSE(DecodeNunchuk({}));
}

/// WiiBrew's table, forwards: what a Classic sends for these counts.
Six EncodeClassic(const ClassicCounts& c) {
  const auto byte = [](int value) { return static_cast<std::uint8_t>(value); };
  return {byte((c.right_x >> 3) << 6 | c.left_x),
          byte((c.right_x >> 1 & 3) << 6 | c.left_y),
          byte((c.right_x & 1) << 7 | (c.left_trigger >> 3) << 5 | c.right_y),
          byte((c.left_trigger & 7) << 5 | c.right_trigger),
          byte(~(c.buttons >> 8)),
          byte(~c.buttons)};
}

TEST(Classic, EveryStickTriggerAndButtonComesBack) {
  for (int i = 0; i < 64; ++i) {
    ClassicCounts sent;
    sent.left_x = static_cast<std::uint8_t>(i);
    sent.left_y = static_cast<std::uint8_t>(63 - i);
    sent.right_x = static_cast<std::uint8_t>(i / 2);
    sent.right_y = static_cast<std::uint8_t>(31 - i / 2);
    sent.left_trigger = static_cast<std::uint8_t>((i * 7) % 32);
    sent.right_trigger = static_cast<std::uint8_t>((i * 11) % 32);
    sent.buttons = static_cast<std::uint16_t>(1 << (i % 16)) & 0xfeff;
    const auto got = DecodeClassic(EncodeClassic(sent));
    ASSERT_TRUE(got);
    EXPECT_EQ(got->left_x, sent.left_x);
    EXPECT_EQ(got->left_y, sent.left_y);
    EXPECT_EQ(got->right_x, sent.right_x);
    EXPECT_EQ(got->right_y, sent.right_y);
    EXPECT_EQ(got->left_trigger, sent.left_trigger);
    EXPECT_EQ(got->right_trigger, sent.right_trigger);
    EXPECT_EQ(got->buttons, sent.buttons);
  }
}

TEST(Classic, PassedByTheMotionPlusHasUpAndLeftElsewhere) {
  // Up: bit 0 of byte 0, left: bit 0 of byte 1; 0 is pressed.
  const auto up = DecodePassedClassic(Six{0x20, 0x21, 0x10, 0x00, 0xff, 0xfc});
  ASSERT_TRUE(up);
  EXPECT_EQ(up->buttons, kClassicUp);
  EXPECT_EQ(up->left_x, 0x20);
  EXPECT_EQ(up->left_y, 0x20);
  const auto left = DecodePassedClassic(Six{0x21, 0x20, 0x10, 0x00, 0xff, 0xfc});
  ASSERT_TRUE(left);
  EXPECT_EQ(left->buttons, kClassicLeft);
}

TEST(MotionPlus, TakesCountsRangesAndChildFromTheirPlaces) {
  // yaw 0x2a11, roll 0x1522, pitch 0x3f33; yaw slow, pitch fast, roll slow; child there.
  const Six packet = {0x11, 0x22, 0x33, 0x2a << 2 | 2, 0x15 << 2 | 2 | 1, 0x3f << 2 | 2};
  ASSERT_EQ(PacketOf(packet), PassedPacket::kMotionPlus);
  const auto counts = DecodeMotionPlus(packet);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->counts[kYaw], 0x2a11);
  EXPECT_EQ(counts->counts[kRoll], 0x1522);
  EXPECT_EQ(counts->counts[kPitch], 0x3f33);
  EXPECT_TRUE(counts->slow[kYaw]);
  EXPECT_TRUE(counts->slow[kRoll]);
  EXPECT_FALSE(counts->slow[kPitch]);
  EXPECT_TRUE(counts->extension_connected);
  EXPECT_EQ(ChildConnected(packet), true);
}

TEST(MotionPlus, SlowBitsBelongToOneAxisEach) {
  const auto slow_of = [](std::uint8_t b3, std::uint8_t b4) {
    return DecodeMotionPlus(Six{1, 1, 1, b3, b4, 0x82})->slow;
  };
  EXPECT_EQ(slow_of(0x80, 0x80), (std::array<bool, 3>{false, false, false}));
  EXPECT_EQ(slow_of(0x82, 0x80), (std::array<bool, 3>{true, false, false}));
  EXPECT_EQ(slow_of(0x80, 0x82), (std::array<bool, 3>{false, true, false}));
  EXPECT_EQ(slow_of(0x81, 0x80), (std::array<bool, 3>{false, false, true}));
}

TEST(MotionPlus, TellsItsPacketsFromItsChildsAndFromRubbish) {
  EXPECT_EQ(PacketOf(Six{0x80, 0x80, 0x80, 0x80, 0xb3, 0x0c}), PassedPacket::kExtension);
  EXPECT_FALSE(DecodeMotionPlus(Six{0x80, 0x80, 0x80, 0x80, 0xb3, 0x0c}));
  EXPECT_EQ(ChildConnected(Six{0x80, 0x80, 0x80, 0x80, 0xb2, 0x0c}), false);
  for (const Six& rubbish :
       {Six(6, 0xff), Six(6, 0x00), Six(5, 0x82), Six{}, Six{0x80, 0x80, 0x80, 0x80, 0x80, 0x83}}) {
    EXPECT_EQ(PacketOf(rubbish), PassedPacket::kRubbish);
    EXPECT_FALSE(DecodeMotionPlus(rubbish));
    EXPECT_FALSE(ChildConnected(rubbish));
  }
}

using Bytes6 = std::vector<std::uint8_t>;

TEST(Extension, IsKnownByItsIdentityWhateverTheFirstByte) {
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x00, 0x00}), Extension::kNunchuk);
  EXPECT_EQ(IdentifyExtension(Bytes6{0xff, 0x00, 0xa4, 0x20, 0x00, 0x00}), Extension::kNunchuk);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x04, 0x02}),
            Extension::kBalanceBoard);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x00, 0x00, 0xa4, 0x20, 0x01, 0x01}), Extension::kClassic);
}

TEST(Extension, RubbishMeansNotReadyRatherThanNone) {
  EXPECT_EQ(IdentifyExtension(Bytes6(6, 0xff)), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension(Bytes6{0xff, 0x00, 0xff, 0xff, 0xff, 0xff}), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension(Bytes6{0x2e, 0x2e, 0x2e, 0x2e, 0x2e, 0x2e}), Extension::kNotReady);
  EXPECT_EQ(IdentifyExtension({}), Extension::kNotReady);
}

TEST(Extension, ARealBoardReport) {
  // wiiuse issue 42, after the two button bytes.
  const std::vector<std::uint8_t> bytes = {0x03, 0xd0, 0x19, 0x1a, 0x00, 0x17,
                                           0x15, 0x23, 0x19, 0x00, 0x6e, 0x00};
  const auto counts = DecodeBoard(bytes);
  ASSERT_TRUE(counts);
  EXPECT_EQ(counts->corners[kTopRight], 0x03d0);
  EXPECT_EQ(counts->corners[kBottomRight], 0x191a);
  EXPECT_EQ(counts->corners[kTopLeft], 0x0017);
  EXPECT_EQ(counts->corners[kBottomLeft], 0x1523);
  EXPECT_EQ(counts->temperature, 0x19);
  EXPECT_EQ(counts->battery, 0x6e);
}

TEST(Extension, AShortBoardReportLacksTemperatureAndBattery) {
  const std::vector<std::uint8_t> bytes(8, 0x11);
  const auto counts = DecodeBoard(bytes);
  ASSERT_TRUE(counts);
  EXPECT_FALSE(counts->has_temperature);
  EXPECT_FALSE(counts->has_battery);
  EXPECT_FALSE(DecodeBoard(Bytes(bytes).first(7)));
}

TEST(Extension, BoardBatteryRisesFromEmptyToFull) {
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0x00), 0);
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0x78), 0.5);
  EXPECT_DOUBLE_EQ(BoardBatteryFraction(0xff), 1);
  for (int raw = 1; raw < 256; ++raw) {
    EXPECT_GE(BoardBatteryFraction(static_cast<std::uint8_t>(raw)),
              BoardBatteryFraction(static_cast<std::uint8_t>(raw - 1)));
  }
}

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

using InterleaverReport = std::vector<std::uint8_t>;

/// A half with buttons b0 b1, an acceleration byte and 18 camera bytes that count up.
InterleaverReport HalfReport(std::uint8_t id, std::uint8_t b0, std::uint8_t b1, std::uint8_t axis,
                             std::uint8_t first_camera_byte) {
  InterleaverReport report = {id, b0, b1, axis};
  report.resize(22);
  std::iota(report.begin() + 4, report.end(), first_camera_byte);
  return report;
}

Data DataOf(const InterleaverReport& report) { return std::get<Data>(Decode(report).body); }

TEST(Interleaver, JoinsAPair) {
  Interleaver interleaver;
  // z = 0x9c = 1001'1100: bits 7,6 = 2 in 3e b1; 5,4 = 1 in 3e b0; 3,2 = 3 in 3f b1; 1,0 = 0 in 3f
  // b0.
  const Data first = DataOf(HalfReport(0x3e, 1 << 5, 2 << 5, 0x81, 0));
  EXPECT_EQ(first.half, Half::kFirst);
  EXPECT_FALSE(first.has_acceleration);
  EXPECT_FALSE(interleaver.Take(first));
  const auto pair = interleaver.Take(DataOf(HalfReport(0x3f, 0 << 5, 3 << 5, 0x7d, 18)));
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->half, Half::kNone);
  EXPECT_TRUE(pair->has_acceleration);
  EXPECT_EQ(pair->acceleration_counts,
            (std::array<std::uint16_t, 3>{0x81 << 2, 0x7d << 2, 0x9c << 2}));
  ASSERT_EQ(pair->camera().size(), 36u);
  for (std::uint8_t i = 0; i < 36; ++i) EXPECT_EQ(pair->camera()[i], i);
}

TEST(Interleaver, ALoneHalfGivesNothing) {
  Interleaver interleaver;
  const Data first = DataOf(HalfReport(0x3e, 0, 0, 0x80, 0));
  const Data second = DataOf(HalfReport(0x3f, 0, 0, 0x80, 18));
  EXPECT_FALSE(interleaver.Take(second));
  EXPECT_FALSE(interleaver.Take(first));
  EXPECT_FALSE(interleaver.Take(first)) << "the second one was lost";
  EXPECT_TRUE(interleaver.Take(second)) << "joins the newer first half";
  EXPECT_FALSE(interleaver.Take(second)) << "each half is used once";
}

TEST(Interleaver, AnotherReportInBetweenPassesAndBreaksThePair) {
  Interleaver interleaver;
  EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3e, 0, 0, 0x80, 0))));
  const auto passed = interleaver.Take(DataOf(InterleaverReport{0x31, 0, 0, 0x80, 0x80, 0x9a}));
  ASSERT_TRUE(passed);
  EXPECT_EQ(passed->id, 0x31);
  EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3f, 0, 0, 0x80, 18))));
}

TEST(Interleaver, HalvesCutShortJoinNothing) {
  for (std::size_t size = 3; size < 22; ++size) {
    Interleaver interleaver;
    InterleaverReport cut = HalfReport(0x3e, 0, 0, 0x80, 0);
    cut.resize(size);
    EXPECT_FALSE(interleaver.Take(DataOf(cut))) << size;
    EXPECT_FALSE(interleaver.Take(DataOf(HalfReport(0x3f, 0, 0, 0x80, 18)))) << size;
  }
}

TEST(CameraBytes, AreWhereEachReportHasThem) {
  struct Case {
    std::uint8_t id;
    std::size_t at;
    std::size_t size;
  };
  // Counted from the id byte.
  for (const Case& c : {Case{0x33, 6, 12}, Case{0x36, 3, 10}, Case{0x37, 6, 10}, Case{0x3e, 4, 18},
                        Case{0x3f, 4, 18}}) {
    InterleaverReport report(22);
    std::iota(report.begin(), report.end(), std::uint8_t{0});
    report[0] = c.id;
    if (c.id == 0x33) report.resize(18);
    const Data data = DataOf(report);
    ASSERT_EQ(data.camera().size(), c.size) << int{c.id};
    EXPECT_EQ(data.camera().front(), c.at) << int{c.id};
    EXPECT_EQ(data.camera().back(), c.at + c.size - 1) << int{c.id};
    report.resize(c.at + c.size - 1);
    EXPECT_TRUE(DataOf(report).camera().empty()) << "cut short";
  }
}

TEST(ShortForms, OfEveryDataReportCarryButtonsOnly) {
  // The kernel takes ids 0x30 to 0x3f with two bytes of payload; only 0x3d has no buttons.
  for (const std::uint8_t id : {0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x36, 0x37, 0x3e, 0x3f}) {
    const InputReport report = Decode(InterleaverReport{id, 0xff, 0xff});
    EXPECT_EQ(report.buttons, 0x1f9f) << int{id};
    const Data& data = std::get<Data>(report.body);
    EXPECT_FALSE(data.has_acceleration);
    EXPECT_TRUE(data.extension().empty());
    EXPECT_TRUE(data.camera().empty());
  }
}

TEST(RandomBytes, DecodeToSomethingWithinItsBounds) {
  std::mt19937 random(1);
  MemoryRead read(Space::kEeprom, 0, 0x1700);
  int decoded_count = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::vector<std::uint8_t> bytes(random() % 40);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    // Most ids are unknown; half of the reports get a known range.
    if (!bytes.empty() && i % 2 == 0) bytes[0] = static_cast<std::uint8_t>(0x20 + random() % 32);
    const InputReport decoded = Decode(bytes);
    ASSERT_EQ(decoded.buttons & ~0x1f9f, 0);
    if (!std::holds_alternative<Undecodable>(decoded.body)) ++decoded_count;
    if (const auto* data = std::get_if<Data>(&decoded.body)) {
      for (const std::uint16_t count : data->acceleration_counts) ASSERT_LE(count, 1023);
      ASSERT_LE(data->extension_size, 21);
      DecodeBoard(data->extension());
    }
    if (const auto* memory = std::get_if<MemoryData>(&decoded.body)) {
      ASSERT_LE(memory->size, 16);
      read.Take(*memory);
      ASSERT_LE(read.bytes().size(), 0x1700u);
    }
    IdentifyExtension(bytes);
  }
  EXPECT_GT(decoded_count, 1000);
}

}  // namespace
}  // namespace footing::reports
