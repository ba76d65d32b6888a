#include "common/camera/disc_fitter.h"

#include <gtest/gtest.h>

namespace footing::sphere::disc {
namespace {

constexpr double kSdPx = 1.5;

MotionEvidence Evidence(double blur_noise_px, double travel_noise_px) {
  MotionEvidence evidence;
  evidence.change.setZero();
  evidence.information.setZero();
  evidence.information.diagonal() << Eigen::Vector2d::Constant(1 / (blur_noise_px * blur_noise_px)),
      Eigen::Vector2d::Constant(1 / (travel_noise_px * travel_noise_px));
  evidence.blur_px = 1;
  evidence.per_blur = {0, 0, 2};
  evidence.per_travel << 1, 0, 0, 1, 0.5, 0;
  return evidence;
}

TEST(UnseenMotion, IsThatOfAnyHandWhenNothingIsSeen) {
  const Eigen::Matrix3d square = UnseenMotion(Evidence(1e3, 1e3), kSdPx);
  // Travel s along each axis; an even blur m²/48 with E[m⁴] = 8 s⁴. One hand in 100 rests.
  const double travel = kSdPx * kSdPx, blur = 8 * std::pow(kSdPx, 4) / (48 * 48);
  EXPECT_NEAR(square(0, 0), 0.99 * travel, 0.05 * travel);
  EXPECT_NEAR(square(1, 1), 0.99 * travel, 0.05 * travel);
  EXPECT_NEAR(square(0, 1), 0, 0.01 * travel);
  EXPECT_NEAR(square(2, 2), 0.99 * (4 * blur + 0.25 * travel), 0.05 * (4 * blur + 0.25 * travel));
}

TEST(UnseenMotion, IsLittleWhereAHandThatMovesWouldBeSeen) {
  // A hand that moves shows so little travel once in (1.5 / 0.01)² = 22 500 times; one in 100
  // rests.
  const double noise_px = 0.01;
  const Eigen::Matrix3d square = UnseenMotion(Evidence(0.5, noise_px), kSdPx);
  const double moves = 99.0 * noise_px * noise_px / (kSdPx * kSdPx + noise_px * noise_px);
  EXPECT_NEAR(square(0, 0), moves / (1 + moves) * noise_px * noise_px,
              0.1 * moves * noise_px * noise_px);
}

TEST(UnseenMotion, IsTheTravelThatIsSeen) {
  MotionEvidence evidence = Evidence(0.5, 0.1);
  evidence.change << 0, 0, 0.3, 0;  // Three deviations: one in 40 of these is a hand at rest.
  const Eigen::Matrix3d square = UnseenMotion(evidence, kSdPx);
  EXPECT_NEAR(square(0, 0), 0.975 * (0.3 * 0.3 + 0.1 * 0.1), 0.01);
  EXPECT_NEAR(square(1, 1), 0.975 * 0.1 * 0.1, 0.002);
}

}  // namespace
}  // namespace footing::sphere::disc
