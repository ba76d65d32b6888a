#include <gtest/gtest.h>

#include <vector>

#include "daemon/sensor/reports/extension.h"

namespace footing::reports {
namespace {

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

}  // namespace
}  // namespace footing::reports
