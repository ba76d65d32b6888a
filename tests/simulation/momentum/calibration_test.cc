#include "daemon/simulation/momentum/calibration.h"

#include <gtest/gtest.h>

#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

TEST(TPoseCalibration, GivesWeightAndTheCopOfEachFootAfterFiveSeconds) {
  MadeBody body;
  body.noise_n = 0.5;
  body.com_m = [](double) { return Eigen::Vector3d(0.03, 0.02, kMadeHeightM); };
  TPoseCalibration calibration;
  int frames = 0;
  while (!calibration.Advance(body.At(frames * kMadeStepS), kMadeStepS)) ASSERT_LT(++frames, 400);
  EXPECT_NEAR(frames * kMadeStepS, TPoseCalibration::kSeconds, 0.05);
  const TPose& pose = calibration.result();
  EXPECT_NEAR(pose.mass_kg, kMadeMassKg, 0.02);
  // 2 cm to the left of the middle between boards 32 cm apart: 1/2 + 2/32 of the load.
  EXPECT_NEAR(pose.load_n[0], kMadeMassKg * kStandardGravityMps2 * 0.5625, 0.5);
  EXPECT_NEAR(pose.p_WP_m[1].x(), 0.03, 1e-3);
  EXPECT_NEAR(pose.p_WP_m[1].y(), -kBoardYM, 1e-3);
  EXPECT_NEAR(pose.cell_noise_n, 0.5, 0.05);
  EXPECT_EQ(calibration.restarts(), 0u);
}

TEST(TPoseCalibration, BeginsAnewWhenTheBodyMoves) {
  MadeBody body;
  body.com_m = [](double t) {
    return Eigen::Vector3d(0, 0, kMadeHeightM + 0.1 * std::sin(6 * t) * Ramp(t - 3));
  };
  TPoseCalibration calibration;
  for (int i = 0; i < 360; ++i)
    EXPECT_FALSE(calibration.Advance(body.At(i * kMadeStepS), kMadeStepS));
  EXPECT_GE(calibration.restarts(), 1u);
}

TEST(TPoseCalibration, WantsBothFeet) {
  MadeBody body;
  TPoseCalibration calibration;
  for (int i = 0; i < 400; ++i) {
    ContactLoads loads = body.At(i * kMadeStepS);
    loads.feet[1].valid = false;
    EXPECT_FALSE(calibration.Advance(loads, kMadeStepS));
  }
  EXPECT_EQ(calibration.progress(), 0);
}

}  // namespace
}  // namespace footing::momentum
