#include "daemon/sensor/reports/calibration_motion_plus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <vector>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;
using testing::HasSubstr;
using MotionPlusBlock = std::vector<std::uint8_t>;

// Four real units: two of Dolphin's old sources, two of a thread of the WiiBrew forum (2009).
const MotionPlusBlock kA = {0x7b, 0xec, 0x76, 0xca, 0x76, 0x2c, 0x32, 0xdc, 0xcc, 0xd7, 0x2e,
                            0xa8, 0xc8, 0x77, 0x5e, 0x02, 0x76, 0x0f, 0x79, 0x3d, 0x77, 0x9b,
                            0x39, 0x43, 0xca, 0xa8, 0x31, 0xc8, 0x2d, 0x1c, 0xbc, 0x33};
const MotionPlusBlock kB = {0x79, 0xbe, 0x77, 0x5a, 0x77, 0x38, 0x2f, 0x90, 0xcd, 0x3b, 0x2f,
                            0xfd, 0xc8, 0x29, 0x9c, 0x75, 0x7d, 0xd4, 0x78, 0xef, 0x78, 0x8a,
                            0x35, 0xa6, 0xc9, 0x9b, 0x33, 0x50, 0x2d, 0x00, 0xbd, 0x23};
const MotionPlusBlock kC = {0x79, 0x83, 0x73, 0x54, 0x72, 0xe8, 0x30, 0xc3, 0xcc, 0x4a, 0x34,
                            0xfc, 0xc8, 0x4f, 0xcc, 0x5b, 0x77, 0x49, 0x75, 0xa4, 0x73, 0x9a,
                            0x35, 0x52, 0xca, 0x22, 0x37, 0x26, 0x2d, 0xe5, 0xb5, 0xa2};
const MotionPlusBlock kD = {0x78, 0xd9, 0x78, 0x38, 0x77, 0x9d, 0x2f, 0x0c, 0xcf, 0xf0, 0x31,
                            0xad, 0xc8, 0x0b, 0x5e, 0x39, 0x6f, 0x81, 0x7b, 0x89, 0x78, 0x51,
                            0x33, 0x60, 0xc9, 0xf5, 0x37, 0xc1, 0x2d, 0xe9, 0x15, 0x8d};

MotionPlusBlock MotionPlusWithChecksum(MotionPlusBlock block) {
  uLong crc = crc32(crc32(0, nullptr, 0), block.data(), 14);
  crc = crc32(crc, block.data() + 16, 14);
  block[14] = static_cast<std::uint8_t>(crc >> 24);
  block[15] = static_cast<std::uint8_t>(crc >> 16);
  block[30] = static_cast<std::uint8_t>(crc >> 8);
  block[31] = static_cast<std::uint8_t>(crc);
  return block;
}

TEST(MotionPlusCalibration, ReadsFourRealBlocks) {
  for (const MotionPlusBlock& block : {kA, kB, kC, kD}) {
    const auto calibration = ParseMotionPlus(block);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
    EXPECT_EQ(calibration.problem, "");
    EXPECT_DOUBLE_EQ(calibration.fast.degrees_per_s, 1200);
    EXPECT_DOUBLE_EQ(calibration.slow.degrees_per_s, 270);
  }
  const auto a = ParseMotionPlus(kA);
  EXPECT_EQ(a.fast.zero, (std::array<int, 3>{0x7bec, 0x76ca, 0x762c}));
  EXPECT_EQ(a.fast.scale, (std::array<int, 3>{0x32dc, 0xccd7, 0x2ea8}));
  EXPECT_EQ(a.slow.zero, (std::array<int, 3>{0x760f, 0x793d, 0x779b}));
  EXPECT_EQ(a.slow.scale, (std::array<int, 3>{0x3943, 0xcaa8, 0x31c8}));
}

TEST(MotionPlusCalibration, UnusableBlocksGiveTypicalValuesAndTheReason) {
  const auto refuse = [](const MotionPlusBlock& block, const char* why) {
    const auto calibration = ParseMotionPlus(block);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
    EXPECT_THAT(calibration.problem, HasSubstr(why));
    EXPECT_EQ(calibration.fast.zero[0], 0x8000);
  };
  MotionPlusBlock flipped = kA;
  flipped[3] ^= 0x10;
  refuse(flipped, "checksum");
  MotionPlusBlock still = kA;
  still[28] = 0;  // Degrees of the slow range.
  refuse(MotionPlusWithChecksum(still), "degrees are 0");
  MotionPlusBlock flat = kA;
  flat[6] = flat[0];  // Scale of yaw at its zero.
  flat[7] = flat[1];
  refuse(MotionPlusWithChecksum(flat), "scale is at its zero");
  refuse(MotionPlusBlock(32, 0xff), "all FF");
  refuse(MotionPlusBlock(32, 0x00), "all 00");
  refuse(MotionPlusBlock(kA.begin(), kA.begin() + 31), "not read");
  refuse({}, "not read");
}

reports::MotionPlusCounts CountsOf16(int yaw, int roll, int pitch, bool slow) {
  reports::MotionPlusCounts counts;
  counts.counts = {static_cast<std::uint16_t>(yaw / 4), static_cast<std::uint16_t>(roll / 4),
                   static_cast<std::uint16_t>(pitch / 4)};
  counts.slow = {slow, slow, slow};
  return counts;
}

TEST(MotionPlus, ReadsDegreesOfTheBlockAtItsScale) {
  const auto calibration = ParseMotionPlus(kA);
  // A quarter of a count is lost by the packet's 14 bits: 3 of 14000 counts are 0.06 degrees/s
  // slow.
  const auto slow = Calibrate(calibration, CountsOf16(0x3943, 0xcaa8, 0x31c8, true));
  EXPECT_NEAR(slow.angular_velocity_S_radps.z(), DegreesToRadians(270), 2e-3) << "yaw right";
  EXPECT_NEAR(slow.angular_velocity_S_radps.y(), -DegreesToRadians(270), 2e-3) << "roll";
  EXPECT_NEAR(slow.angular_velocity_S_radps.x(), -DegreesToRadians(270), 2e-3) << "pitch";
  const auto fast = Calibrate(calibration, CountsOf16(0x32dc, 0xccd7, 0x2ea8, false));
  EXPECT_NEAR(fast.angular_velocity_S_radps.z(), DegreesToRadians(1200), 8e-3);
}

TEST(MotionPlus, EachAxisHasItsOwnRange) {
  const auto calibration = ParseMotionPlus(kA);
  // All at the slow zeros, so the fast axis is off by the difference of the zeros only.
  auto counts = CountsOf16(0x760f, 0x793d, 0x779b, true);
  counts.slow[reports::kYaw] = false;
  const auto reading = Calibrate(calibration, counts);
  EXPECT_NEAR(reading.angular_velocity_S_radps.x(), 0, 2e-3);
  EXPECT_NEAR(reading.angular_velocity_S_radps.y(), 0, 2e-3);
  const double yaw = DegreesToRadians(1200.0 * (0x760f / 4 * 4 - 0x7bec) / (0x32dc - 0x7bec));
  EXPECT_NEAR(reading.angular_velocity_S_radps.z(), yaw, 1e-9);
}

TEST(MotionPlus, ATurnGoesThroughTheChangeOfRangeWithoutAJump) {
  // The same velocity in both ranges, with the typical values.
  const MotionPlusCalibration calibration;
  const double radps = DegreesToRadians(400);
  reports::MotionPlusCounts counts;
  for (const bool slow : {true, false}) {
    const double full_deg = slow ? 440 : 2000;
    counts.counts = {static_cast<std::uint16_t>(std::lround(8192 - 8192 * 400 / full_deg)), 8192,
                     8192};
    counts.slow = {slow, slow, slow};
    EXPECT_NEAR(Calibrate(calibration, counts).angular_velocity_S_radps.z(), radps, 5e-3) << slow;
  }
}

TEST(MotionPlus, TellsTheEndOfItsRange) {
  EXPECT_FALSE(Calibrate({}, CountsOf16(0x8000, 0x8000, 0x8000, false)).clipped);
  EXPECT_TRUE(Calibrate({}, CountsOf16(0xffff, 0x8000, 0x8000, false)).clipped);
  EXPECT_TRUE(Calibrate({}, CountsOf16(0x8000, 0x8000, 0, false)).clipped);
}

}  // namespace
}  // namespace footing::calibration
