#include "daemon/sensor/reports/nunchuk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;
using testing::HasSubstr;
using NunchukBlock = std::vector<std::uint8_t>;

constexpr double kNunchukG = kStandardGravityMps2;

// A real Nunchuk's (Adafruit_CircuitPython_Nunchuk issue 12).
const NunchukBlock kNunchukReal = {0x7d, 0x7a, 0x7e, 0x0a, 0xb0, 0xaf, 0xb1, 0x12,
                                   0xe5, 0x21, 0x7c, 0xe7, 0x23, 0x7a, 0xfc, 0x51};

NunchukBlock NunchukTwo(const NunchukBlock& first, const NunchukBlock& second) {
  NunchukBlock both = first;
  both.insert(both.end(), second.begin(), second.end());
  return both;
}

NunchukBlock WithChecksums(NunchukBlock block) {
  std::uint8_t sum = 0x55;
  for (std::size_t i = 0; i < 14; ++i) sum = static_cast<std::uint8_t>(sum + block[i]);
  block[14] = sum;
  block[15] = static_cast<std::uint8_t>(sum + 0x55);
  return block;
}

reports::NunchukCounts CountsOfNunchuk(std::uint16_t x, std::uint16_t y, std::uint16_t z) {
  reports::NunchukCounts counts;
  counts.stick_x = 0x7c;
  counts.stick_y = 0x7a;
  counts.acceleration = {x, y, z};
  return counts;
}

TEST(NunchukCalibration, ReadsARealBlock) {
  const auto calibration = ParseNunchuk(NunchukTwo(kNunchukReal, kNunchukReal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  // 0x0a = 00'10'10: x 0, y 2, z 2; 0x12 = 01'00'10: x 1, y 0, z 2.
  EXPECT_EQ(calibration.zero_counts, (std::array<int, 3>{500, 490, 506}));
  EXPECT_EQ(calibration.one_g_counts, (std::array<int, 3>{705, 700, 710}));
  EXPECT_EQ(calibration.stick_x.low, 0x21);
  EXPECT_EQ(calibration.stick_x.middle, 0x7c);
  EXPECT_EQ(calibration.stick_x.high, 0xe5);
  EXPECT_EQ(calibration.stick_y.low, 0x23);
  EXPECT_EQ(calibration.stick_y.middle, 0x7a);
  EXPECT_EQ(calibration.stick_y.high, 0xe7);
}

TEST(NunchukCalibration, TheMotionPlusCopyHasOneBlock) {
  EXPECT_EQ(ParseNunchuk(kNunchukReal).origin, CalibrationOrigin::kDevice);
}

TEST(NunchukCalibration, EitherChecksumCounts) {
  for (const std::size_t at : {14u, 15u}) {
    NunchukBlock bad = kNunchukReal;
    bad[at] ^= 1;
    const auto calibration = ParseNunchuk(NunchukTwo(bad, kNunchukReal));
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDeviceCopy);
    EXPECT_THAT(calibration.problem, HasSubstr("checksum"));
  }
}

TEST(NunchukCalibration, UnusableBlocksGiveTypicalValues) {
  NunchukBlock equal = kNunchukReal;
  for (std::size_t i = 0; i < 4; ++i) equal[4 + i] = equal[i];  // 1 g == 0 g.
  for (const NunchukBlock& bad :
       {NunchukBlock(32, 0x00), NunchukBlock(32, 0xff), NunchukBlock{}, NunchukBlock(15, 0x80),
        NunchukTwo(WithChecksums(equal), WithChecksums(equal))}) {
    const auto calibration = ParseNunchuk(bad);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
    EXPECT_NE(calibration.problem, "");
    EXPECT_EQ(calibration.zero_counts[0], 0x200);
    EXPECT_EQ(calibration.one_g_counts[0], 0x2cc);
    EXPECT_EQ(calibration.stick_x.middle, 128);
  }
}

TEST(NunchukCalibration, AnImpossibleStickLeavesTheAccelerometer) {
  NunchukBlock bad = kNunchukReal;
  bad[8] = bad[10];  // Upper end at the middle.
  const auto calibration = ParseNunchuk(WithChecksums(bad));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_THAT(calibration.problem, HasSubstr("stick"));
  EXPECT_EQ(calibration.zero_counts[0], 500);
  EXPECT_EQ(calibration.stick_x.high, 224);
}

TEST(Nunchuk, AccelerationIsInTheSensorFrame) {
  const auto calibration = ParseNunchuk(kNunchukReal);
  // Held still, stick up; then left side up; then rear up.
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(500, 490, 710))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(0, 0, -kNunchukG)));
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(705, 490, 506))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(kNunchukG, 0, 0)));
  EXPECT_TRUE(Calibrate(calibration, CountsOfNunchuk(500, 700, 506))
                  .specific_force_S_mps2.isApprox(Eigen::Vector3d(0, -kNunchukG, 0)));
}

TEST(Nunchuk, StickReachesOneAtItsEndsAndNotBeyond) {
  const auto calibration = ParseNunchuk(kNunchukReal);
  auto counts = CountsOfNunchuk(500, 490, 506);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 0);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, 0);
  counts.stick_x = 0xe5;
  counts.stick_y = 0x23;
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 1);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, -1);
  counts.stick_x = 0xff;
  counts.stick_y = 0x00;
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_x, 1);
  EXPECT_DOUBLE_EQ(Calibrate(calibration, counts).stick_y, -1);
}

TEST(Nunchuk, TellsClippedAxes) {
  EXPECT_EQ(Calibrate(ParseNunchuk(kNunchukReal), CountsOfNunchuk(1023, 490, 2)).clipped_axes,
            0b101u);
}

}  // namespace
}  // namespace footing::calibration
