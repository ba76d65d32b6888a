#include "daemon/sensor/reports/acceleration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

using stream::CalibrationOrigin;
using testing::HasSubstr;
using Block = std::vector<std::uint8_t>;
using Counts = std::array<std::uint16_t, 3>;

constexpr double kG = kStandardGravityMps2;

// A real remote's block (EEPROM 0x16) and the idealised one.
const Block kReal = {0x82, 0x82, 0x82, 0x15, 0x9c, 0x9c, 0x9e, 0x38, 0x40, 0x3e};
const Block kIdeal = {0x80, 0x80, 0x80, 0x00, 0x9a, 0x9a, 0x9a, 0x00, 0x40, 0xe3};
const Block kOther = {0x85, 0x85, 0x85, 0x00, 0xa0, 0xa0, 0xa0, 0x00, 0x40, 0x04};

Block Two(const Block& first, const Block& second) {
  Block both = first;
  both.insert(both.end(), second.begin(), second.end());
  return both;
}

Block WithChecksum(Block block) {
  std::uint8_t sum = 0x55;
  for (std::size_t i = 0; i < 9; ++i) sum = static_cast<std::uint8_t>(sum + block[i]);
  block[9] = sum;
  return block;
}

TEST(AccelerationCalibration, ReadsARealBlock) {
  const auto calibration = ParseAcceleration(Two(kReal, kReal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  EXPECT_EQ(calibration.zero_counts, (std::array<int, 3>{521, 521, 521}));
  EXPECT_EQ(calibration.one_g_counts, (std::array<int, 3>{627, 626, 632}));
  EXPECT_EQ(ParseAcceleration(Two(kOther, kOther)).origin, CalibrationOrigin::kDevice);
}

TEST(AccelerationCalibration, ABadFirstBlockFallsBackToTheCopy) {
  Block bad = kReal;
  bad[9] ^= 1;
  const auto calibration = ParseAcceleration(Two(bad, kIdeal));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDeviceCopy);
  EXPECT_EQ(calibration.zero_counts[0], 0x200);
  EXPECT_THAT(calibration.problem, HasSubstr("block 1: checksum is wrong"));
}

TEST(AccelerationCalibration, ImpossibleBlocksAreRefusedByName) {
  const struct {
    const char* what;
    Block block;
    const char* problem;
  } kBlocks[] = {
      {"all FF", Block(10, 0xff), "checksum is wrong"},  // 9 * FF + 55 = 4C
      {"all 00", Block(10, 0x00), "checksum is wrong"},  // 0 + 55 = 55
      {"1 g at zero", WithChecksum({0x80, 0x80, 0x80, 0, 0x80, 0x80, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"1 g below zero", WithChecksum({0x9a, 0x9a, 0x9a, 0, 0x80, 0x80, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"one axis only", WithChecksum({0x80, 0x80, 0x80, 0, 0x9a, 0x9a, 0x80, 0, 0x40, 0}),
       "1 g is impossible"},
      {"zero far off", WithChecksum({0x10, 0x80, 0x80, 0, 0x2a, 0x9a, 0x9a, 0, 0x40, 0}),
       "zero point is impossible"},
  };
  for (const auto& [what, block, problem] : kBlocks) {
    const auto calibration = ParseAcceleration(Two(block, block));
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults) << what;
    EXPECT_THAT(calibration.problem, HasSubstr(problem)) << what;
    const auto sample = Calibrate(calibration, Counts{0x200, 0x200, 0x268});
    EXPECT_TRUE(sample.specific_force_S_mps2.allFinite()) << what;
  }
}

TEST(AccelerationCalibration, WithoutAnAnswerTypicalValuesAreUsedAndSaidSo) {
  const auto calibration = ParseAcceleration({});
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
  EXPECT_THAT(calibration.problem, HasSubstr("not read"));
  EXPECT_EQ(calibration.zero_counts[0], 0x80 << 2);
  EXPECT_EQ(calibration.one_g_counts[0], 0x9a << 2);
}

TEST(Acceleration, AtRestFaceUpPointsAlongMinusZ) {
  // Raw z reads +1 g with the buttons up; S's z points down.
  const auto sample = Calibrate(ParseAcceleration(Two(kReal, kReal)), Counts{521, 521, 632});
  EXPECT_NEAR(sample.specific_force_S_mps2.x(), 0, 1e-12);
  EXPECT_NEAR(sample.specific_force_S_mps2.y(), 0, 1e-12);
  EXPECT_NEAR(sample.specific_force_S_mps2.z(), -kG, 1e-12);
  EXPECT_EQ(sample.clipped_axes, 0u);
}

TEST(Acceleration, LeftSideUpIsPlusXAndPortUpIsMinusY) {
  const auto calibration = ParseAcceleration(Two(kReal, kReal));
  const auto left_up = Calibrate(calibration, Counts{627, 521, 521});
  EXPECT_NEAR(left_up.specific_force_S_mps2.x(), kG, 1e-12);
  const auto port_up = Calibrate(calibration, Counts{521, 626, 521});
  EXPECT_NEAR(port_up.specific_force_S_mps2.y(), -kG, 1e-12);
}

TEST(Acceleration, OnlyTheEndsOfTheCountRangeAreClipped) {
  const auto calibration = ParseAcceleration(Two(kIdeal, kIdeal));
  EXPECT_EQ(Calibrate(calibration, Counts{0, 512, 512}).clipped_axes, 1u);
  EXPECT_EQ(Calibrate(calibration, Counts{512, 1022, 512}).clipped_axes, 2u);
  EXPECT_EQ(Calibrate(calibration, Counts{512, 512, 1020}).clipped_axes, 4u);
  EXPECT_EQ(Calibrate(calibration, Counts{1023, 0, 1022}).clipped_axes, 7u);
  // 4 g is beyond the sensor's nominal range, yet a reading of it is no end of the counts.
  EXPECT_EQ(Calibrate(calibration, Counts{512 + 4 * 104, 512, 512}).clipped_axes, 0u);
}

}  // namespace
}  // namespace footing::calibration
