#include "daemon/sensor/reports/move_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "common/base/units.h"
#include "tests/common/move_calibrations.h"

namespace footing::calibration {
namespace {

using reports::MoveModel;
using stream::CalibrationOrigin;
using testing::HasSubstr;
using MoveBytes = std::vector<std::uint8_t>;

constexpr double kMoveG = kStandardGravityMps2;

MoveBytes Join(MoveModel model, const std::vector<MoveBytes>& pieces) {
  MoveBlob blob(model);
  for (const MoveBytes& piece : pieces) EXPECT_TRUE(blob.Take(piece));
  EXPECT_TRUE(blob.complete());
  return blob.bytes();
}

TEST(MoveBlob, TakesPiecesInAnyOrderAndAgain) {
  MoveBlob blob(MoveModel::kZcm1);
  EXPECT_FALSE(blob.complete());
  EXPECT_TRUE(blob.Take(test::kRealZcm1[2]));
  EXPECT_TRUE(blob.Take(test::kRealZcm1[2]));
  EXPECT_TRUE(blob.Take(test::kRealZcm1[0]));
  EXPECT_FALSE(blob.complete());
  EXPECT_TRUE(blob.Take(test::kRealZcm1[1]));
  EXPECT_TRUE(blob.complete());
  EXPECT_EQ(blob.bytes(), Join(MoveModel::kZcm1, test::kRealZcm1));
  EXPECT_EQ(blob.bytes().size(), 143u);
  EXPECT_EQ(Join(MoveModel::kZcm2, test::kRealZcm2).size(), 96u);
}

TEST(MoveBlob, LeavesAsideWhatIsNoPiece) {
  MoveBlob blob(MoveModel::kZcm2);
  EXPECT_FALSE(blob.Take(MoveBytes{}));
  EXPECT_FALSE(blob.Take(MoveBytes(test::kRealZcm2[0].begin(), test::kRealZcm2[0].begin() + 48)));
  EXPECT_FALSE(blob.Take(test::kRealZcm1[1])) << "middle piece of the other model";
  EXPECT_FALSE(blob.Take(test::kRealZcm1[2])) << "last piece of the other model";
  MoveBytes other = test::kRealZcm2[0];
  other[0] = 0x11;
  EXPECT_FALSE(blob.Take(other));
  EXPECT_TRUE(blob.bytes().empty());
}

TEST(MoveCalibration, ReadsARealBlobOfTheFirstModel) {
  const auto calibration = ParseMove(MoveModel::kZcm1, Join(MoveModel::kZcm1, test::kRealZcm1));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_EQ(calibration.problem, "");
  // x: 0x6e85 and 0x9098, y: 0x6ee6 and 0x90c9, z: 0x6e1a and 0x8fe8; each less 0x8000.
  EXPECT_DOUBLE_EQ(calibration.acceleration_zero_counts[0], (-4475 + 4248) / 2.0);
  EXPECT_DOUBLE_EQ(calibration.acceleration_gain_mps2[0], 2 * kMoveG / (4248 + 4475));
  EXPECT_DOUBLE_EQ(calibration.acceleration_gain_mps2[1], 2 * kMoveG / (4297 + 4378));
  EXPECT_DOUBLE_EQ(calibration.acceleration_gain_mps2[2], 2 * kMoveG / (4072 + 4582));
  // x: 0x94e5 - 0x8000 = 5349 at 80 rpm, bias 0x7fa5 - 0x8000 = -91 times 0.98858.
  EXPECT_NEAR(calibration.gyroscope_gain_radps[0], 80 * 2 * kPi / 60 / (5349 + 91 * 0.98858), 1e-8);
  EXPECT_DOUBLE_EQ(calibration.gyroscope_zero_counts[0], 0);
}

TEST(MoveCalibration, ReadsARealBlobOfTheSecondModel) {
  const auto calibration = ParseMove(MoveModel::kZcm2, Join(MoveModel::kZcm2, test::kRealZcm2));
  EXPECT_EQ(calibration.origin, CalibrationOrigin::kDevice);
  EXPECT_DOUBLE_EQ(calibration.acceleration_gain_mps2[0], 2 * kMoveG / (4130 + 4069));
  EXPECT_DOUBLE_EQ(calibration.acceleration_gain_mps2[2], 2 * kMoveG / (4094 + 4138));
  EXPECT_EQ(calibration.gyroscope_zero_counts, (std::array<double, 3>{-5, 7, -1}));
  // y: 0x1aac = 6828 forth, 0xe563 = -6813 back.
  EXPECT_NEAR(calibration.gyroscope_gain_radps[1], 90 * 2 * kPi / 60 / 6820.5, 1e-9);
}

TEST(MoveCalibration, ABiasFactorThatIsNoNumberIsLeftOut) {
  MoveBytes blob = Join(MoveModel::kZcm1, test::kRealZcm1);
  for (const float factor : {std::numeric_limits<float>::quiet_NaN(),
                             std::numeric_limits<float>::infinity(), 0.f, -1.f, 1e30f}) {
    std::memcpy(blob.data() + 0x6a, &factor, sizeof factor);
    const auto calibration = ParseMove(MoveModel::kZcm1, blob);
    EXPECT_NEAR(calibration.gyroscope_gain_radps[0], 80 * 2 * kPi / 60 / (5349 + 91), 1e-12);
  }
}

TEST(MoveCalibration, UnusableBlobsGiveTypicalValuesAndTheReason) {
  const auto refuse = [](MoveModel model, const MoveBytes& blob, const char* why) {
    const auto calibration = ParseMove(model, blob);
    EXPECT_EQ(calibration.origin, CalibrationOrigin::kDefaults);
    EXPECT_THAT(calibration.problem, HasSubstr(why));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(calibration.acceleration_gain_mps2[i], 0);
      EXPECT_GT(calibration.gyroscope_gain_radps[i], 0);
    }
  };
  const MoveBytes first = Join(MoveModel::kZcm1, test::kRealZcm1);
  const MoveBytes second = Join(MoveModel::kZcm2, test::kRealZcm2);
  refuse(MoveModel::kZcm1, {}, "not read");
  refuse(MoveModel::kZcm1, second, "cut short");
  refuse(MoveModel::kZcm2, first, "another model");
  refuse(MoveModel::kZcm1, MoveBytes(143, 0x00), "all 00");
  refuse(MoveModel::kZcm1, MoveBytes(143, 0xff), "all FF");
  MoveBytes flat = first;
  flat[0x0a] = flat[0x16];  // -1 g of x is +1 g of x.
  flat[0x0b] = flat[0x17];
  refuse(MoveModel::kZcm1, flat, "1 g");
  MoveBytes still = second;
  still[0x42] = still[0x30];  // Back is forth about x.
  still[0x43] = still[0x31];
  refuse(MoveModel::kZcm2, still, "gyroscope");
}

TEST(Move, ARealReportAtRestReadsOneGAndHardlyTurns) {
  // moveonpc wiki, "Input report"; with another unit's calibration, so only roughly.
  reports::MoveReport report;
  report.sample_count = 2;
  report.samples[0].acceleration = {0x092d, -0x0058, 0x0d77};
  report.samples[0].angular_velocity = {-8, 2, -5};
  const auto reading = Calibrate(DefaultMove(MoveModel::kZcm1), report, 0);
  EXPECT_NEAR(reading.specific_force_S_mps2.norm(), kMoveG, 0.5);
  EXPECT_LT(reading.specific_force_S_mps2.z(), 0) << "buttons up";
  EXPECT_LT(reading.angular_velocity_S_radps.norm(), 0.02);
}

TEST(Move, IsInTheSensorFrame) {
  const auto calibration = DefaultMove(MoveModel::kZcm2);
  reports::MoveReport report;
  report.sample_count = 1;
  const auto force = [&](std::int16_t x, std::int16_t y, std::int16_t z) {
    report.samples[0].acceleration = {x, y, z};
    report.samples[0].angular_velocity = {x, y, z};
    return Calibrate(calibration, report, 0);
  };
  EXPECT_TRUE(force(0, 0, 4096).specific_force_S_mps2.isApprox(Eigen::Vector3d(0, 0, -kMoveG)));
  EXPECT_TRUE(force(0, 4096, 0).specific_force_S_mps2.isApprox(Eigen::Vector3d(0, kMoveG, 0)));
  EXPECT_TRUE(force(4096, 0, 0).specific_force_S_mps2.isApprox(Eigen::Vector3d(-kMoveG, 0, 0)));
  EXPECT_GT(force(0, 4096, 0).angular_velocity_S_radps.y(), 0);
  EXPECT_LT(force(4096, 0, 4096).angular_velocity_S_radps.x(), 0);
  EXPECT_LT(force(4096, 0, 4096).angular_velocity_S_radps.z(), 0);
  report.has_magnetic_field = true;
  report.magnetic_field = {1, 2, 3};
  EXPECT_EQ(MagneticField(report), Eigen::Vector3d(-1, -2, -3));
}

TEST(Move, TellsClippedAxes) {
  reports::MoveReport report;
  report.sample_count = 1;
  report.samples[0].acceleration = {-32768, 0, 32767};
  report.samples[0].angular_velocity = {0, 32767, 0};
  const auto reading = Calibrate(DefaultMove(MoveModel::kZcm2), report, 0);
  EXPECT_EQ(reading.clipped_axes, 0b101u);
  EXPECT_TRUE(reading.angular_velocity_clipped);
}

}  // namespace
}  // namespace footing::calibration
