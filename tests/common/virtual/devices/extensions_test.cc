#include "common/virtual/devices/extensions.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace footing::virtual_devices {
namespace {

constexpr double kG = 9.80665;
constexpr double kDegree = std::numbers::pi / 180;

/// Calibration of a real Nunchuk; its z has zero 0x7e << 2 | 2 = 506 and 1 g 0xb1 << 2 | 2 = 710.
constexpr NunchukBlock kNunchuk = {0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf, 0xb1, 0x12,
                                   0xe5, 0x21, 0x7c, 0xe7, 0x23, 0x7a, 0xfc, 0x51};
/// Calibrations of two real MotionPlus.
constexpr MotionPlusBlock kMotionPlusA = {
    0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e, 0xa8, 0xc8, 0x77, 0x5e, 0x02,
    0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b, 0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};
constexpr MotionPlusBlock kMotionPlusB = {
    0x79, 0xbe, 0x77, 0x5a, 0x77, 0x38, 0x2f, 0x90, 0xcd, 0x3b, 0x2f, 0xfd, 0xc8, 0x29, 0x9c, 0x75,
    0x7d, 0xd4, 0x78, 0xef, 0x78, 0x8a, 0x35, 0xa6, 0xc9, 0x9b, 0x33, 0x50, 0x2d, 0x00, 0xbd, 0x23};

int CountsOf(const ExtensionBytes& bytes, std::size_t axis) {
  return bytes[2 + axis] << 2 | (bytes[5] >> (2 + 2 * axis) & 3);
}
int GyroscopeOf(const ExtensionBytes& bytes, std::size_t axis) {
  return (bytes[3 + axis] >> 2) << 8 | bytes[axis];
}
bool YawIsSlow(const ExtensionBytes& bytes) { return bytes[3] & 2; }
bool RollIsSlow(const ExtensionBytes& bytes) { return bytes[4] & 2; }
bool PitchIsSlow(const ExtensionBytes& bytes) { return bytes[3] & 1; }

TEST(Nunchuk, ARealUnitsBlockGivesTheCountsOfThatUnit) {
  NunchukSensors sensors;
  ExtensionBytes bytes = NunchukBytes(kNunchuk, sensors);
  EXPECT_EQ(bytes[0], 0x7c);  // The stick's middles.
  EXPECT_EQ(bytes[1], 0x7a);
  EXPECT_EQ(CountsOf(bytes, 0), 0x7d << 2 | 0);
  EXPECT_EQ(CountsOf(bytes, 1), 0x7a << 2 | 2);
  EXPECT_EQ(CountsOf(bytes, 2), 710);
  EXPECT_EQ(bytes[5] & 3, 3);  // Nothing pressed.

  sensors.specific_force_S_mps2 = {kG, -kG, 0};  // Left side up is raw +x, rear up is raw +y.
  sensors.stick_x = 1;
  sensors.stick_y = -1;
  sensors.c = true;
  bytes = NunchukBytes(kNunchuk, sensors);
  EXPECT_EQ(bytes[0], 0xe5);
  EXPECT_EQ(bytes[1], 0x23);
  EXPECT_EQ(CountsOf(bytes, 0), 0xb0 << 2 | 1);
  EXPECT_EQ(CountsOf(bytes, 1), 0xaf << 2 | 0);
  EXPECT_EQ(CountsOf(bytes, 2), 506);
  EXPECT_EQ(bytes[5] & 3, 1);  // C pressed, Z not.
}

TEST(Nunchuk, DrawnBlocksHaveBothChecksums) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const NunchukBlock block = DrawNunchukBlock(seed);
    int sum = 0x55;
    for (std::size_t i = 0; i < 14; ++i) sum += block[i];
    EXPECT_EQ(block[14], sum & 0xff);
    EXPECT_EQ(block[15], (sum + 0x55) & 0xff);
  }
}

TEST(Nunchuk, EndsAtTheRangeAndTakesWhatIsNotFiniteAsZero) {
  NunchukSensors sensors;
  sensors.specific_force_S_mps2 = {1e9, 1e9, std::numeric_limits<double>::quiet_NaN()};
  sensors.stick_x = 5;
  sensors.stick_y = std::numeric_limits<double>::infinity();
  const ExtensionBytes bytes = NunchukBytes(kNunchuk, sensors);
  EXPECT_EQ(CountsOf(bytes, 0), 1023);
  EXPECT_EQ(CountsOf(bytes, 1), 0);
  EXPECT_EQ(CountsOf(bytes, 2), 506);
  EXPECT_EQ(bytes[0], 0xe5);
  EXPECT_EQ(bytes[1], 0x7a);
}

TEST(Nunchuk, PassedThroughItLosesTheLowestBits) {
  NunchukSensors sensors;
  sensors.specific_force_S_mps2 = {3, -4, -7};
  sensors.z = true;
  const ExtensionBytes plain = NunchukBytes(kNunchuk, sensors);
  const ExtensionBytes passed = PassedNunchuk(plain);
  EXPECT_EQ(passed[4] & 1, 1);  // Something is plugged in.
  EXPECT_EQ(passed[5] & 3, 0);  // No packet of the MotionPlus.
  EXPECT_EQ(passed[5] >> 3 & 1, 1);
  EXPECT_EQ(passed[5] >> 2 & 1, 0);
  EXPECT_EQ(passed[2] << 2 | (passed[5] >> 4 & 1) << 1, CountsOf(plain, 0) & ~1);
  EXPECT_EQ(passed[3] << 2 | (passed[5] >> 5 & 1) << 1, CountsOf(plain, 1) & ~1);
  EXPECT_EQ((passed[4] & 0xfe) << 2 | (passed[5] >> 6 & 3) << 1, CountsOf(plain, 2) & ~1);
}

TEST(MotionPlus, TheChecksumsOfRealUnitsAreReproduced) {
  for (const MotionPlusBlock& real : {kMotionPlusA, kMotionPlusB}) {
    MotionPlusBlock block = real;
    block[14] = block[15] = block[30] = block[31] = 0;
    PutMotionPlusChecksum(block);
    EXPECT_EQ(block, real);
  }
}

TEST(MotionPlus, RealUnitsTurnedAtTheirReferenceReadTheirScale) {
  // Yaw is about +z, roll about -y, pitch about -x. Slow range: 270 degrees/s.
  ExtensionBytes bytes = MotionPlusBytes(kMotionPlusA, {0, 0, 0}, true);
  EXPECT_NEAR(GyroscopeOf(bytes, 0), 0x760f / 4.0, 0.5);
  EXPECT_NEAR(GyroscopeOf(bytes, 1), 0x793d / 4.0, 0.5);
  EXPECT_NEAR(GyroscopeOf(bytes, 2), 0x779b / 4.0, 0.5);
  EXPECT_TRUE(YawIsSlow(bytes) && RollIsSlow(bytes) && PitchIsSlow(bytes));
  EXPECT_EQ(bytes[4] & 1, 1);
  EXPECT_EQ(bytes[5] & 3, 2);
  bytes = MotionPlusBytes(kMotionPlusA, {-270 * kDegree, -270 * kDegree, 270 * kDegree}, false);
  EXPECT_NEAR(GyroscopeOf(bytes, 0), 0x3943 / 4.0, 0.5);
  EXPECT_NEAR(GyroscopeOf(bytes, 1), 0xcaa8 / 4.0, 0.5);
  EXPECT_NEAR(GyroscopeOf(bytes, 2), 0x31c8 / 4.0, 0.5);
  EXPECT_EQ(bytes[4] & 1, 0);
}

TEST(MotionPlus, EachAxisChoosesItsOwnRange) {
  const ExtensionBytes bytes =
      MotionPlusBytes(kMotionPlusA, {0, -1200 * kDegree, 0}, false);  // Roll alone is fast.
  EXPECT_TRUE(YawIsSlow(bytes));
  EXPECT_FALSE(RollIsSlow(bytes));
  EXPECT_TRUE(PitchIsSlow(bytes));
  EXPECT_NEAR(GyroscopeOf(bytes, 1), 0xccd7 / 4.0, 0.5);
}

TEST(MotionPlus, ClipsAtTheEndOfTheFastRange) {
  const ExtensionBytes bytes = MotionPlusBytes(kMotionPlusA, {-1e6, -1e6, -1e6}, false);
  EXPECT_EQ(GyroscopeOf(bytes, 0), 0x3fff);  // Yaw's scale is below its zero.
  EXPECT_EQ(GyroscopeOf(bytes, 1), 0x3fff);
  EXPECT_EQ(GyroscopeOf(bytes, 2), 0);
}

TEST(MotionPlus, NeverSendsAPacketThatLooksLikeRubbish) {
  for (const double turn : {-1e9, -40.0, -5.0, 0.0, 5.0, 40.0, 1e9}) {
    const ExtensionBytes bytes = MotionPlusBytes(kMotionPlusB, {turn, turn, turn}, true);
    EXPECT_EQ(bytes[5] & 3, 2) << turn;
  }
}

TEST(Classic, PassedThroughItKeepsItsButtons) {
  ExtensionBytes plain = ClassicBytes();
  plain[5] = 0xfe;  // Up is pressed, left is not.
  const ExtensionBytes passed = PassedClassic(plain);
  EXPECT_EQ(passed[0] & 1, 0);
  EXPECT_EQ(passed[1] & 1, 1);
  EXPECT_EQ(passed[5] & 3, 0);
  EXPECT_EQ(passed[4] & 1, 1);
}

}  // namespace
}  // namespace footing::virtual_devices
