#include "common/virtual/camera/render.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "common/virtual/camera/scene.h"

namespace footing::virtual_camera {
namespace {

/// A scene without noise and slope, and a white ball, so that every pixel counts alike.
Scene PlainScene(const Eigen::Vector3d& p_C_m) {
  Scene scene;
  scene.sensor.read_noise_dn = scene.sensor.dn_per_electron = 0;
  scene.background_dn.setZero();
  scene.background_slope_dn.setZero();
  Ball ball;
  ball.p_C_m = p_C_m;
  ball.colour_dn.setConstant(200);
  ball.limb = ball.hot_spot = 0;
  scene.balls = {ball};
  return scene;
}

struct Moments {
  double light = 0;
  Eigen::Vector2d centre{0, 0};
};

Moments MomentsOf(const Mosaic& mosaic) {
  Moments moments;
  for (int v = 0; v < mosaic.height; ++v) {
    for (int u = 0; u < mosaic.width; ++u) {
      const double light = mosaic.bytes[static_cast<std::size_t>(v * mosaic.width + u)];
      moments.light += light;
      moments.centre += light * Eigen::Vector2d(u, v);
    }
  }
  moments.centre /= moments.light;
  return moments;
}

TEST(Render, DiscHasTheAreaOfTheSpheresCone) {
  noise::Random random(1);
  const Moments moments = MomentsOf(Render(PlainScene({0, 0, 1}), random));
  // tan of the half angle is r / sqrt(z² - r²); area pi (f tan)².
  const double radius_px = 540 * 0.0225 / std::sqrt(1 - 0.0225 * 0.0225);
  EXPECT_NEAR(moments.light / 200, M_PI * radius_px * radius_px, 0.5);
  EXPECT_NEAR((moments.centre - Eigen::Vector2d(319.5, 239.5)).norm(), 0, 0.01);
}

TEST(Render, RollingShutterShowsLowerRowsLater) {
  noise::Random random(1);
  Scene scene = PlainScene({0, 0.3, 2});
  scene.balls[0].v_C_mps = {2, 0, 0};
  const auto seen = Truth(scene, scene.balls[0]);
  ASSERT_TRUE(seen);
  // Row 320.5 of 480, 81 below the middle, of a readout of 15.5 ms.
  EXPECT_NEAR(seen->after_s, 0.0155 * 81.0 / 479, 1e-5);
  const Moments moments = MomentsOf(Render(scene, random));
  EXPECT_NEAR(moments.centre.x(), Project(scene.lens, seen->p_C_m).x(), 0.05);
}

TEST(Render, NoiseIsReadNoiseAndShotNoise) {
  noise::Random random(2);
  Scene scene;
  scene.background_dn.setConstant(100);
  scene.background_slope_dn.setZero();
  const Mosaic mosaic = Render(scene, random);
  double sum = 0, square = 0;
  for (const std::uint8_t value : mosaic.bytes) {
    sum += value;
    square += value * value;
  }
  const double count = static_cast<double>(mosaic.bytes.size()), mean = sum / count;
  EXPECT_NEAR(mean, 100, 0.05);
  // Read noise 1.5, 0.03 DN per electron, rounding.
  EXPECT_NEAR(square / count - mean * mean, 1.5 * 1.5 + 0.03 * 100 + 1.0 / 12, 0.1);
}

TEST(Render, HidesTheShareThatIsAskedFor) {
  noise::Random random(3);
  Scene scene = PlainScene({0, 0, 0.6});
  const double all = MomentsOf(Render(scene, random)).light;
  scene.occluders = {Hide(scene, scene.balls[0], 0.25, random)};
  scene.occluders[0].colour_dn.setZero();
  EXPECT_NEAR(MomentsOf(Render(scene, random)).light / all, 0.75, 0.01);
}

TEST(Render, YuyvOfGreyHasNoChroma) {
  noise::Random random(4);
  const auto bytes = ToYuyv(Render(PlainScene({0, 0, 1}), random));
  ASSERT_EQ(bytes.size(), 640u * 480 * 2);
  const std::size_t middle = 2 * (240 * 640 + 320);
  EXPECT_NEAR(bytes[middle], 200, 1);
  EXPECT_NEAR(bytes[middle + 1], 128, 1);
  EXPECT_NEAR(bytes[middle + 3], 128, 1);
}

TEST(RandomScene, ClutterLeavesTheHueAroundABallAlone) {
  noise::Random random(5);
  Scene scene;
  scene.balls = {Ball()};
  AddClutter(scene, 300, random);
  ASSERT_EQ(scene.shapes.size(), 301u);
  EXPECT_GT(scene.shapes.back().colour_dn.minCoeff(), 255);  // The lamp.
  for (int i = 0; i < 300; ++i)
    EXPECT_LE(scene.shapes[static_cast<std::size_t>(i)].colour_dn.maxCoeff(), 120);
}

}  // namespace
}  // namespace footing::virtual_camera
