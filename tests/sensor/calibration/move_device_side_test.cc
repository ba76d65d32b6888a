#include <gtest/gtest.h>

#include "common/device_models/ps_move.h"
#include "daemon/sensor/calibration/move.h"
#include "daemon/sensor/reports/move_report.h"

/// What the PS Move's model sends, read by the decoder.
namespace footing::calibration {
namespace {

using reports::MoveModel;

class MoveDeviceSide : public testing::TestWithParam<MoveModel> {
 protected:
  static device_models::PsMove Make(std::uint64_t seed) {
    return {seed, GetParam() == MoveModel::kZcm1 ? device_models::MoveModel::kZcm1
                                                 : device_models::MoveModel::kZcm2};
  }
  static MoveCalibration Read(device_models::PsMove& move) {
    MoveBlob blob(GetParam());
    while (!blob.complete()) blob.Take(move.Feature(0x10, 49).value());
    EXPECT_EQ(blob.bytes(), move.blob());
    return ParseMove(GetParam(), blob.bytes());
  }
};

TEST_P(MoveDeviceSide, BothHalvesAreReadBackInSi) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    device_models::PsMove move = Make(seed);
    const auto calibration = Read(move);
    ASSERT_EQ(calibration.origin, stream::CalibrationOrigin::kDevice) << calibration.problem;
    device_models::MoveSensors older, newer;
    older.specific_force_S_mps2 = {1, -2, -9};
    older.angular_velocity_S_radps = {0.5, -4, 8};
    newer.specific_force_S_mps2 = {-15, 20, 3};
    newer.angular_velocity_S_radps = {-9, 0.01, 0};
    newer.trigger = 0.5;
    newer.buttons = reports::kMoveTrigger | reports::kMoveMove | reports::kMoveStart;
    newer.magnetic_field_S_counts = {100, -200, 300};
    const auto report = reports::DecodeMove(GetParam(), move.Sample(0, older, newer).at(0));
    ASSERT_TRUE(report);
    EXPECT_EQ(report->buttons, newer.buttons);
    for (std::size_t half = 0; half < report->sample_count; ++half) {
      const auto& true_one = half + 1 == report->sample_count ? newer : older;
      const auto reading = Calibrate(calibration, *report, half);
      EXPECT_LE((reading.specific_force_S_mps2 - true_one.specific_force_S_mps2).norm(), 0.004);
      EXPECT_LE((reading.angular_velocity_S_radps - true_one.angular_velocity_S_radps).norm(),
                0.004);
      EXPECT_EQ(reading.clipped_axes, 0u);
    }
    EXPECT_NEAR(Calibrate(calibration, *report, report->sample_count - 1).trigger, 0.5, 0.01);
    EXPECT_NEAR(reports::MoveTemperature(report->temperature), 20, 0.1);
    if (GetParam() == MoveModel::kZcm1) {
      EXPECT_EQ(report->sample_count, 2u);
      EXPECT_EQ(MagneticField(*report), newer.magnetic_field_S_counts);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, MoveDeviceSide,
                         testing::Values(MoveModel::kZcm1, MoveModel::kZcm2));

}  // namespace
}  // namespace footing::calibration
