#include "daemon/sensor/reports/board_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <vector>

#include "common/base/units.h"

namespace footing::calibration {
namespace {

using reports::BoardCounts;
using stream::CalibrationOrigin;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;
using Points = std::array<std::array<int, 4>, 3>;  // At 0, 17, 34 kg: TR BR TL BL.

const Bytes kTemperature = {0x19, 0x01};
constexpr Points kPoints = {
    {{2779, 4163, 8300, 7056}, {4379, 5863, 9900, 8656}, {6079, 7463, 11600, 10356}}};

Bytes MakeBlock(const Points& points, const Bytes& temperature = kTemperature) {
  Bytes block = {0x01, 0x69, 0x00, 0x00};
  for (const auto& row : points) {
    for (const int count : row) {
      block.push_back(static_cast<std::uint8_t>(count >> 8));
      block.push_back(static_cast<std::uint8_t>(count));
    }
  }
  uLong crc = crc32(0, block.data() + 4, 24);
  crc = crc32(crc, block.data(), 2);
  crc = crc32(crc, temperature.data(), 2);
  for (int shift = 24; shift >= 0; shift -= 8) {
    block.push_back(static_cast<std::uint8_t>(crc >> shift));
  }
  return block;
}

BoardCounts CountsOf(int top_right, int bottom_right, int top_left, int bottom_left) {
  BoardCounts counts;
  counts.corners = {static_cast<std::uint16_t>(top_right), static_cast<std::uint16_t>(bottom_right),
                    static_cast<std::uint16_t>(top_left), static_cast<std::uint16_t>(bottom_left)};
  return counts;
}

TEST(BoardCalibration, IsReadWhenItsChecksumIsRight) {
  const auto calibration = ParseBoard(MakeBlock(kPoints), kTemperature);
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  EXPECT_EQ(calibration.counts, kPoints);
  EXPECT_EQ(calibration.reference_temperature, 0x19);
}

TEST(BoardCalibration, EveryFlippedBitIsNoticed) {
  const Bytes good = MakeBlock(kPoints);
  for (std::size_t byte = 0; byte < good.size(); ++byte) {
    if (byte == 2 || byte == 3) continue;  // The checksum does not cover these two.
    for (int bit = 0; bit < 8; ++bit) {
      Bytes bad = good;
      bad[byte] = static_cast<std::uint8_t>(bad[byte] ^ 1 << bit);
      EXPECT_EQ(ParseBoard(bad, kTemperature).origin, CalibrationOrigin::kDefaults) << byte;
    }
  }
}

TEST(BoardCalibration, ImpossibleBlocksAreRefusedByName) {
  // wjoy issue 35: seen in the field.
  constexpr Points kField = {
      {{26880, 0, 56076, 10761}, {26902, 26630, 23315, 55311}, {61212, 28941, 60953, 36630}}};
  Points equal = kPoints;
  equal[1][2] = equal[0][2];
  Points falling = kPoints;
  falling[2][3] = falling[1][3] - 1;
  const struct {
    const char* what;
    Bytes block;
    const char* problem;
  } kBlocks[] = {
      {"all FF", Bytes(32, 0xff), "all FF"},
      {"all 00", Bytes(32, 0x00), "all 00"},
      {"equal", MakeBlock(equal), "equal"},
      {"falling", MakeBlock(falling), "do not rise"},
      {"field", MakeBlock(kField), "do not rise"},
      {"cut short", Bytes(20, 0x11), "not read"},
      {"empty", {}, "not read"},
  };
  for (const auto& [what, block, problem] : kBlocks) {
    const auto calibration = ParseBoard(block, kTemperature);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults) << what;
    EXPECT_THAT(calibration.problem, HasSubstr(problem)) << what;
    for (const int count : {0, 0x17, 30000, 65535}) {
      for (const double force : CornerForces(calibration, CountsOf(count, count, count, count))) {
        EXPECT_TRUE(std::isfinite(force)) << what;
      }
    }
  }
}

TEST(BoardCalibration, AnImpossibleReferenceTemperatureIsNotUsed) {
  for (const std::uint8_t reference : {0x00, 0xff}) {
    const Bytes temperature = {reference, 0x01};
    const auto calibration = ParseBoard(MakeBlock(kPoints, temperature), temperature);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
    EXPECT_FALSE(calibration.has_reference_temperature);
  }
}

TEST(CornerForces, AreExactAtTheCalibrationPoints) {
  const auto calibration = ParseBoard(MakeBlock(kPoints), kTemperature);
  for (int point = 0; point < 3; ++point) {
    const auto& row = kPoints[static_cast<std::size_t>(point)];
    for (const double force : CornerForces(calibration, CountsOf(row[0], row[1], row[2], row[3]))) {
      EXPECT_NEAR(force, KilogramsToNewtons(17.0 * point * 0.99908), 1e-9);
    }
  }
}

TEST(CornerForces, GoOnAlongTheOuterSlopes) {
  const auto calibration = ParseBoard(MakeBlock(kPoints), kTemperature);
  // Top right: 1600 counts from 0 to 17 kg, 1700 from 17 to 34 kg.
  const auto below = CornerForces(calibration, CountsOf(2779 - 160, 4163, 8300, 7056));
  EXPECT_NEAR(below[reports::kTopRight], -KilogramsToNewtons(1.7 * 0.99908), 1e-9);
  const auto above = CornerForces(calibration, CountsOf(6079 + 1700, 4163, 8300, 7056));
  EXPECT_NEAR(above[reports::kTopRight], KilogramsToNewtons(51 * 0.99908), 1e-9);
}

TEST(CornerForces, AWarmerBoardReadsSevenInTenThousandMoreADegree) {
  const auto calibration = ParseBoard(MakeBlock(kPoints), kTemperature);
  BoardCounts counts = CountsOf(4379, 5863, 9900, 8656);
  counts.has_temperature = true;
  counts.temperature = 0x19 + 10;
  EXPECT_NEAR(CornerForces(calibration, counts)[0], KilogramsToNewtons(17) * 0.99908 * (1 - 0.007),
              1e-9);
}

TEST(CornerForces, WeighTheSameMassWhereGravityIsWeaker) {
  const auto calibration = ParseBoard(MakeBlock(kPoints), kTemperature);
  // At the equator (9.780 m/s²) 17 kg press as 17 kg * 9.780 / 9.80665 do under standard gravity.
  const double equator_mps2 = 9.780;
  const double counts = 2779 + 1600 * equator_mps2 / kStandardGravityMps2;
  const auto rounded = static_cast<std::uint16_t>(std::lround(counts));
  const double force =
      CornerForces(calibration, CountsOf(rounded, 4163, 8300, 7056), equator_mps2)[0];
  // Half a count is 17 kg / 1600 / 2.
  EXPECT_NEAR(NewtonsToKilograms(force) / 0.99908, 17, 17.0 / 1600);
}

}  // namespace
}  // namespace footing::calibration
