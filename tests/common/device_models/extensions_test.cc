#include "common/device_models/extensions.h"

#include <gtest/gtest.h>
#include <zlib.h>

namespace footing::device_models {
namespace {

/// adafruit/Adafruit_CircuitPython_Nunchuk, issue 12.
constexpr NunchukBlock kRealNunchuk = {0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf, 0xb1, 0x12,
                                       0xe5, 0x21, 0x7c, 0xe7, 0x23, 0x7a, 0xfc, 0x51};
/// Unit A of Dolphin's old sources.
constexpr MotionPlusBlock kRealMotionPlus = {
    0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e, 0xa8, 0xc8, 0x77, 0x5e, 0x02,
    0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b, 0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};

TEST(Extensions, DrawnNunchukBlocksHaveTheChecksumsOfTheRealOne) {
  const auto sums = [](const NunchukBlock& block) {
    int sum = 0x55;
    for (std::size_t i = 0; i < 14; ++i) sum += block[i];
    return std::pair(sum & 0xff, (sum + 0x55) & 0xff);
  };
  EXPECT_EQ(sums(kRealNunchuk), std::pair(0xfc, 0x51));
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const NunchukBlock block = DrawNunchukBlock(seed);
    EXPECT_EQ(sums(block), (std::pair<int, int>(block[14], block[15])));
  }
}

TEST(Extensions, DrawnMotionPlusBlocksHaveTheChecksumOfTheRealOne) {
  const auto crc = [](const MotionPlusBlock& block) {
    uLong value = crc32(0, block.data(), 14);
    return static_cast<std::uint32_t>(crc32(value, block.data() + 16, 14));
  };
  EXPECT_EQ(crc(kRealMotionPlus), 0x5e02bc33u);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const MotionPlusBlock block = DrawMotionPlusBlock(seed);
    const std::uint32_t stored = static_cast<std::uint32_t>(block[14]) << 24 |
                                 static_cast<std::uint32_t>(block[15]) << 16 |
                                 static_cast<std::uint32_t>(block[30]) << 8 | block[31];
    EXPECT_EQ(crc(block), stored);
  }
}

TEST(Extensions, TheRealNunchukAtRestSendsItsOwnOneG) {
  const ExtensionBytes bytes = NunchukBytes(kRealNunchuk, {});
  EXPECT_EQ(bytes[0], 0x7c);  // Stick in the middle.
  EXPECT_EQ(bytes[1], 0x7a);
  EXPECT_EQ(bytes[2], 0x7d);  // x and y at 0 g, z at 1 g: upper eight bits as in the block.
  EXPECT_EQ(bytes[3], 0x7a);
  EXPECT_EQ(bytes[4], 0xb1);
  EXPECT_EQ(bytes[5] & 0x03, 0x03);  // No button.
  // Low bits: x 0, y 2, z 2 (0x0a and 0x12 of the block).
  EXPECT_EQ(bytes[5] >> 2 & 3, 0);
  EXPECT_EQ(bytes[5] >> 4 & 3, 2);
  EXPECT_EQ(bytes[5] >> 6 & 3, 2);
}

TEST(Extensions, TheRealMotionPlusAtRestSendsItsSlowZeros) {
  const ExtensionBytes bytes = MotionPlusBytes(kRealMotionPlus, {0, 0, 0}, false);
  const int yaw = bytes[0] | (bytes[3] >> 2) << 8;
  const int roll = bytes[1] | (bytes[4] >> 2) << 8;
  const int pitch = bytes[2] | (bytes[5] >> 2) << 8;
  EXPECT_NEAR(4 * yaw, 0x760f, 2);
  EXPECT_NEAR(4 * roll, 0x793d, 2);
  EXPECT_NEAR(4 * pitch, 0x779b, 2);
  EXPECT_EQ(bytes[3] & 3, 3);
  EXPECT_EQ(bytes[4] & 3, 2);
}

TEST(Extensions, TheRealMotionPlusAt270DegreesASecondSendsItsSlowScale) {
  // Its slow yaw leaves the range there: the fast one is at 270/1200 of the way.
  constexpr double k270 = 270 * 3.14159265358979 / 180;
  const ExtensionBytes bytes = MotionPlusBytes(kRealMotionPlus, {0, -k270, 0}, false);
  const int roll = bytes[1] | (bytes[4] >> 2) << 8;
  EXPECT_NEAR(4 * roll, 0xcaa8, 2);
  EXPECT_EQ(bytes[4] & 2, 2);
}

TEST(Extensions, NothingImpossibleIsSent) {
  NunchukSensors sensors;
  sensors.stick_x = 1e9;
  sensors.stick_y = std::nan("");
  sensors.specific_force_S_mps2 = {1e300, std::nan(""), -1e300};
  const ExtensionBytes bytes = NunchukBytes(kRealNunchuk, sensors);
  EXPECT_EQ(bytes[0], 0xe5);
  EXPECT_EQ(bytes[1], 0x7a);
  EXPECT_EQ(bytes[2], 0xff);
  EXPECT_EQ(bytes[4], 0xff);
  const ExtensionBytes turning = MotionPlusBytes(kRealMotionPlus, {1e300, std::nan(""), 0}, true);
  EXPECT_EQ(turning[4] & 1, 1);
}

}  // namespace
}  // namespace footing::device_models
