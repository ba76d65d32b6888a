// The finder on frames of a renderer that shares no code with it.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "common/camera/find.h"
#include "common/virtual/camera/random_scene.h"
#include "common/virtual/camera/render.h"
#include "common/virtual/camera/yuyv.h"
#include "tests/common/camera/rendered.h"

namespace footing::sphere {
namespace {

namespace camera = virtual_camera;

const Eigen::Vector3d kMagenta(170, 40, 150), kCyan(40, 170, 160);

camera::Ball BallAt(const Eigen::Vector3d& p_C_m, const Eigen::Vector3d& colour = kMagenta) {
  camera::Ball ball;
  ball.p_C_m = p_C_m;
  ball.colour_dn = colour;
  return ball;
}

/// Errors along the line of sight and across it, mm.
struct Errors {
  double bias = 0, sd = 0, lateral = 0, nees = 0;
  int found = 0;
};

template <typename Change>
Errors Measure(double depth_m, int count, const Change& change) {
  noise::Random random(17 + static_cast<std::uint64_t>(100 * depth_m));
  Finder finder(Lens(), {Target()}, Settings());
  Errors errors;
  double square = 0;
  for (int i = 0; i < count; ++i) {
    camera::Scene scene;
    scene.balls.push_back(BallAt(camera::PlaceInView(scene.lens, depth_m, 0.8, random)));
    change(scene, random);
    const auto mosaic = camera::Render(scene, random);
    const auto found = finder.Find(View(mosaic)).front();
    if (!found) continue;
    const Eigen::Vector3d truth = camera::Truth(scene, scene.balls.front())->p_C_m;
    const Eigen::Vector3d error = 1000 * (found->p_C_m - truth), along = truth.normalized();
    const double depth = error.dot(along);
    ++errors.found;
    errors.bias += depth;
    square += depth * depth;
    errors.lateral += (error - depth * along).squaredNorm();
    errors.nees += error.dot((1e6 * found->covariance_m2).inverse() * error) / 3;
  }
  errors.bias /= errors.found;
  errors.sd = std::sqrt(square / errors.found - errors.bias * errors.bias);
  errors.lateral = std::sqrt(errors.lateral / errors.found);
  errors.nees /= errors.found;
  return errors;
}

const auto kAsItIs = [](camera::Scene&, noise::Random&) {};

TEST(Finder, MeetsTheBarAtTwoMetres) {
  const Errors errors = Measure(2, 40, kAsItIs);
  EXPECT_EQ(errors.found, 40);
  EXPECT_LE(errors.lateral, 0.25);
  EXPECT_LE(std::abs(errors.bias), 3 + 2 * 5 / std::sqrt(40));  // Two standard errors of the mean.
  EXPECT_LE(errors.sd, 6);
  EXPECT_GT(errors.nees, 0.5);
  EXPECT_LT(errors.nees, 1.6);
}

TEST(Finder, StatesDepthLessSurelyThanTheSides) {
  noise::Random random(1);
  camera::Scene scene;
  scene.balls.push_back(BallAt({0, 0, 3}));
  const auto found = Finder(Lens(), {Target()}, {}).Find(View(camera::Render(scene, random)));
  ASSERT_TRUE(found[0]);
  EXPECT_GT(found[0]->covariance_m2(2, 2), 100 * found[0]->covariance_m2(0, 0));
  EXPECT_GT(found[0]->confidence, 0.9);
}

TEST(Finder, MeasuresABallOfWhichAQuarterIsHidden) {
  const Errors errors = Measure(2, 24, [](camera::Scene& scene, noise::Random& random) {
    scene.occluders.push_back(camera::Hide(scene, scene.balls.front(), 0.25, random));
  });
  EXPECT_EQ(errors.found, 24);
  EXPECT_LE(errors.lateral, 0.6);
  EXPECT_LE(std::hypot(errors.bias, errors.sd), 20);
}

TEST(Finder, TellsTwoHuesApartAndSaysWhenOneIsAbsent) {
  noise::Random random(5);
  camera::Scene scene;
  scene.balls = {BallAt({-0.3, 0.1, 1.8}), BallAt({0.25, -0.2, 2.1}, kCyan)};
  Target magenta, cyan;
  cyan.colour_dn = kCyan;
  Finder finder(Lens(), {cyan, magenta}, Settings());
  const auto both = finder.Find(View(camera::Render(scene, random)));
  ASSERT_TRUE(both[0] && both[1]);
  EXPECT_LT((both[0]->p_C_m - scene.balls[1].p_C_m).norm(), 0.03);
  EXPECT_LT((both[1]->p_C_m - scene.balls[0].p_C_m).norm(), 0.03);
  scene.balls.pop_back();
  const auto one = finder.Find(View(camera::Render(scene, random)));
  EXPECT_FALSE(one[0]);
  EXPECT_TRUE(one[1]);
}

TEST(Finder, MovesWithTheImage) {
  noise::Random random(6);
  camera::Scene scene;
  scene.balls = {BallAt({0, 0, 2})};
  auto mosaic = camera::Render(scene, random);
  Finder finder(Lens(), {Target()}, Settings());
  const auto before = finder.Find(View(mosaic))[0];
  std::rotate(mosaic.bytes.begin(), mosaic.bytes.end() - 6, mosaic.bytes.end());
  const auto after = finder.Find(View(mosaic))[0];
  ASSERT_TRUE(before && after);
  EXPECT_NEAR((after->centre_px - before->centre_px).x(), 6, 0.01);
  EXPECT_NEAR((after->centre_px - before->centre_px).y(), 0, 0.01);
}

TEST(Finder, SeesThroughALensThatBends) {
  noise::Random random(7);
  camera::Scene scene;
  scene.lens.k1 = -0.12;
  scene.lens.k2 = 0.02;
  scene.balls = {BallAt(camera::RayThrough(scene.lens, {560, 410}) * 1.5)};
  Lens lens;
  lens.k1 = -0.12;
  lens.k2 = 0.02;
  const auto image = camera::Render(scene, random);
  const auto found = Finder(lens, {Target()}, Settings()).Find(View(image))[0];
  ASSERT_TRUE(found);
  EXPECT_LT((found->p_C_m - scene.balls[0].p_C_m).norm(), 0.01);
  // A lens that is not corrected for puts it centimetres off.
  const auto naive = Finder(Lens(), {Target()}, Settings()).Find(View(image))[0];
  ASSERT_TRUE(naive);
  EXPECT_GT((naive->p_C_m - scene.balls[0].p_C_m).norm(), 0.03);
}

TEST(Finder, ReportsLightAtTheLimit) {
  noise::Random random(8);
  camera::Scene scene;
  scene.balls = {BallAt({0, 0, 2}, 1.7 * kMagenta)};
  const auto found =
      Finder(Lens(), {Target()}, Settings()).Find(View(camera::Render(scene, random)));
  ASSERT_TRUE(found[0]);
  EXPECT_TRUE(found[0]->is_saturated);
  EXPECT_LT(found[0]->confidence, 0.5);
}

TEST(Finder, UsesTheLumaOfYuyv) {
  noise::Random random(9);
  camera::Scene scene;
  scene.balls = {BallAt({0.1, 0.05, 1.5})};
  const auto bytes = camera::ToYuyv(camera::Render(scene, random));
  Settings settings;
  settings.profile.blur_px = 1.15;  // With what demosaicing adds.
  settings.profile.blur_sd_px = 0.1;
  settings.noise.correlation = 3;
  const auto found =
      Finder(Lens(), {Target()}, settings).Find({PixelFormat::kYuyv, 640, 480, bytes})[0];
  ASSERT_TRUE(found);
  EXPECT_LT((found->p_C_m - scene.balls[0].p_C_m).norm(), 0.02);
}

TEST(Finder, CalibratesBlurAndLimbWithoutTruth) {
  noise::Random random(10);
  Settings loose;
  loose.profile = {1.3, 0.3, 0.3, 0.3};
  Finder finder(Lens(), {Target()}, loose);
  std::vector<Estimate> estimates;
  for (int i = 0; i < 12; ++i) {
    camera::Scene scene;
    scene.balls = {BallAt(camera::PlaceInView(scene.lens, 0.6 + 0.04 * i, 0.6, random))};
    const auto found = finder.Find(View(camera::Render(scene, random)))[0];
    if (found) estimates.push_back(*found);
  }
  const auto profile = Calibrate(estimates);
  ASSERT_TRUE(profile);
  // Point spread 0.9 px and a pixel's own 1/sqrt(12).
  EXPECT_NEAR(profile->blur_px, std::hypot(0.9, 1 / std::sqrt(12.0)), 0.02);
  EXPECT_NEAR(profile->limb, 0.15, 0.03);
  EXPECT_FALSE(Calibrate({estimates.begin(), estimates.begin() + 3}));
}

}  // namespace
}  // namespace footing::sphere
