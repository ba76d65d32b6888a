// The calibration against rendered spheres whose light it switches.
#include "clients/camera/blink_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/virtual/camera/render.h"
#include "common/virtual/camera/scene.h"

namespace footing::camera {
namespace {

namespace rendered = virtual_camera;
using ::testing::HasSubstr;

/// Controllers before a camera of 12.5 frames a second. A light follows 0.25 s after it was set.
class World {
 public:
  explicit World(double brightness) {
    sensor_dn_ << 140, 25, 10, 20, 130, 30, 10, 25, 150;
    sensor_dn_ *= brightness;
    for (const double side : {-1.0, 1.0}) {
      rendered::Ball ball;
      ball.p_C_m = {0.2 * side, 0.05 * side, 0.8};
      scene_.balls.push_back(ball);
    }
    rendered::AddClutter(scene_, 10, random_);
  }

  Eigen::Vector3d Shown(std::uint32_t rgb) const {
    return Eigen::Vector3d(14, 13, 15) +
           sensor_dn_ * Eigen::Vector3d(rgb >> 16 & 0xff, rgb >> 8 & 0xff, rgb & 0xff) / 255;
  }

  Result<void> Run(BlinkCalibration& calibration) {
    constexpr std::int64_t kFrameNs = 80'000'000, kLateNs = 250'000'000;
    int step = 0;
    std::int64_t lit_ns = 0;
    std::vector<std::uint32_t> lights(2), wanted;
    for (std::int64_t now_ns = 0; now_ns < 60'000'000'000; now_ns += kFrameNs) {
      if (calibration.steps() != step) {
        step = calibration.steps();
        wanted = calibration.lights();
        lit_ns = now_ns + kLateNs;
        calibration.LightsAreSet(now_ns);
      }
      if (now_ns >= lit_ns) lights = wanted;
      const auto image = Render(lights, now_ns);
      const auto taken =
          calibration.Take({sphere::PixelFormat::kSgrbg8, 640, 480, image.bytes}, now_ns);
      if (!taken || calibration.is_done()) return taken;
    }
    return Failure("it does not end");
  }

  rendered::Scene scene_;

 private:
  rendered::Mosaic Render(const std::vector<std::uint32_t>& lights, std::int64_t now_ns) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
      scene_.balls[i].colour_dn = Shown(lights[i]);
      // Hands are never quite still: 4 mm.
      const double t_s = 1e-9 * static_cast<double>(now_ns);
      scene_.balls[i].p_C_m.y() += 0.004 * (std::sin(3 * t_s) - std::sin(3 * (t_s - 0.08)));
    }
    return rendered::Render(scene_, random_);
  }

  Eigen::Matrix3d sensor_dn_;
  noise::Random random_{77};
};

TEST(BlinkCalibration, FindsColourBlurAndLimbOfBothSpheres) {
  World world(1);
  BlinkCalibration calibration(sphere::Lens(), sphere::Settings(), {0.0225, 0.0225});
  const auto done = world.Run(calibration);
  ASSERT_TRUE(done) << done.error().message;
  for (const CalibratedSphere& one : calibration.spheres()) {
    const Eigen::Vector3d shown = world.Shown(one.led_rgb);
    // Limb and hot spot change the middle by 3 % and 6 % at most.
    EXPECT_LT((one.blink.colour_dn - shown).norm(), 0.06 * shown.norm());
    EXPECT_NEAR(one.distance_m, std::sqrt(0.8 * 0.8 + 0.2 * 0.2 + 0.05 * 0.05), 0.01);
  }
  // Point spread 0.9 px and a pixel's own 1/sqrt(12).
  EXPECT_NEAR(calibration.profile().blur_px, std::hypot(0.9, 1 / std::sqrt(12.0)), 0.03);
  EXPECT_NEAR(calibration.profile().limb, 0.15, 0.04);
}

TEST(BlinkCalibration, DimsALightThatTheCameraCannotTake) {
  World world(2.2);
  BlinkCalibration calibration(sphere::Lens(), sphere::Settings(), {0.0225, 0.0225});
  const auto done = world.Run(calibration);
  ASSERT_TRUE(done) << done.error().message;
  for (const CalibratedSphere& one : calibration.spheres()) {
    EXPECT_LT(one.blink.colour_dn.maxCoeff(), 250);
    EXPECT_GT(one.blink.colour_dn.maxCoeff(), 120);
  }
}

TEST(BlinkCalibration, NamesTheControllerThatIsNotInView) {
  World world(1);
  world.scene_.balls[1].p_C_m.x() = 2;
  BlinkCalibration calibration(sphere::Lens(), sphere::Settings(), {0.0225, 0.0225});
  const auto done = world.Run(calibration);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kInvalidData);
  EXPECT_THAT(done.error().message, HasSubstr("controller 2: nothing lights up"));
}

TEST(BlinkCalibration, RefusesWhereBlurCannotBeToldFromDistance) {
  World world(1);
  for (auto& ball : world.scene_.balls) ball.p_C_m *= 3;
  BlinkCalibration calibration(sphere::Lens(), sphere::Settings(), {0.0225, 0.0225});
  const auto done = world.Run(calibration);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("hold it 50 to 120 cm away"));
}

}  // namespace
}  // namespace footing::camera
