#include "common/camera/disc_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "common/camera/blobs.h"
#include "common/camera/lens.h"
#include "common/virtual/camera/scene.h"

namespace footing::sphere {
namespace {

/// Slopes of rays that touch a sphere of radius r at p, by construction: perpendicular to the
/// radius at the point of contact.
std::vector<Eigen::Vector2d> Silhouette(const Eigen::Vector3d& p, double r, int count) {
  const double range = p.norm(), sine = r / range, cosine = std::sqrt(1 - sine * sine);
  const Eigen::Vector3d axis = p / range;
  const Eigen::Vector3d side = axis.unitOrthogonal(), up = axis.cross(side);
  std::vector<Eigen::Vector2d> slopes;
  for (int i = 0; i < count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    const Eigen::Vector3d ray = cosine * axis + sine * (std::cos(a) * side + std::sin(a) * up);
    slopes.emplace_back(ray.head<2>() / ray.z());
  }
  return slopes;
}

TEST(Cone, IsExactForASphereOffTheAxisWhereAnEllipsesMiddleIsNot) {
  const Eigen::Vector3d p(0.02, -0.03, 0.3);
  const auto slopes = Silhouette(p, 0.0225, 16);
  const auto cone = FitCone(slopes, std::vector<bool>(16, true));
  ASSERT_TRUE(cone);
  // tan of the half angle: r / sqrt(|p|² - r²).
  EXPECT_NEAR(cone->tangent, 0.0225 / std::sqrt(p.squaredNorm() - 0.0225 * 0.0225), 1e-10);
  EXPECT_NEAR((cone->axis - p.head<2>() / p.z()).norm(), 0, 1e-10);
  Eigen::Vector2d mean(0, 0);
  for (const auto& one : slopes) mean += one / 16;
  EXPECT_GT((mean - p.head<2>() / p.z()).norm(), 1e-4);
}

TEST(Cone, IgnoresTheEdgeOfAHandOverAThirdOfIt) {
  const Eigen::Vector3d p(0.001, 0.002, 2);
  auto slopes = Silhouette(p, 0.0225, 30);
  for (auto& one : slopes) one.x() = std::min(one.x(), 0.0005 + 0.003);
  const auto fit = FitConeRobustly(slopes, 0.0008, 0.001, 0.1);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->cone.tangent, 0.0225 / 2, 0.0004);
  const auto inliers = std::count(fit->inliers.begin(), fit->inliers.end(), true);
  EXPECT_GE(inliers, 16);
  EXPECT_LE(inliers, 24);
}

TEST(Cone, IsNothingForPointsOnALine) {
  std::vector<Eigen::Vector2d> line;
  for (int i = 0; i < 12; ++i) line.emplace_back(0.001 * i, 0.002 * i);
  EXPECT_FALSE(FitCone(line, std::vector<bool>(12, true)));
}

TEST(Lens, AgreesWithTheRenderersWhichIsWrittenApart) {
  const Lens lens{640, 480, 540, 545, 322, 236, -0.12, 0.03, 0.001, -0.0005, 0};
  ASSERT_EQ(Problem(lens), "");
  const virtual_camera::Lens rendered{640, 480, 540, 545, 322, 236, -0.12, 0.03, 0.001, -0.0005, 0};
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(3, 5), Eigen::Vector2d(630, 470),
                                       Eigen::Vector2d(320, 240), Eigen::Vector2d(100, 400)}) {
    const Eigen::Vector3d ray = virtual_camera::RayThrough(rendered, pixel);
    EXPECT_LT((Undistort(lens, pixel) - ray.head<2>() / ray.z()).norm(), 1e-8);
    EXPECT_LT((ToPixel(lens, Undistort(lens, pixel)) - pixel).norm(), 1e-6);
  }
}

TEST(Lens, SaysWhatIsWrong) {
  Lens lens;
  lens.width = 641;
  EXPECT_NE(Problem(lens), "");
  lens = Lens();
  lens.k1 = -3;  // Folds the image over.
  EXPECT_EQ(Problem(lens), "the distortion cannot be undone at the edges");
}

/// Both discs blurred by brute force on a fine grid.
Eigen::Vector2d BlurredByHand(double x, double blur) {
  const double step = blur / 60;
  double disc = 0, limb = 0, all = 0;
  for (double v = -5 * blur + step / 2; v < 5 * blur; v += step) {
    for (double u = -5 * blur + step * 0.37; u < 5 * blur; u += step) {
      const double weight = std::exp(-0.5 * (u * u + v * v) / (blur * blur));
      const double r = std::hypot(x + u, v);
      all += weight;
      if (r >= 1) continue;
      disc += weight;
      limb += weight * (1 - std::sqrt(1 - r * r));
    }
  }
  return {disc / all, limb / all};
}

TEST(ProfileTable, IsTheConvolutionOfADiscWithAGaussian) {
  const ProfileTable table;
  for (const double blur : {0.045, 0.155, 0.315}) {
    for (const double beyond : {-6.0, -3.0, -1.0, 0.0, 0.5, 2.0}) {
      const double x = 1 + beyond * blur;
      if (x < 0) continue;
      const ProfileValue value = table.At(beyond, blur);
      const Eigen::Vector2d truth = BlurredByHand(x, blur);
      EXPECT_NEAR(value.disc, truth.x(), 5e-4) << blur << " " << beyond;
      EXPECT_NEAR(value.limb, truth.y(), 1e-3) << blur << " " << beyond;
    }
  }
}

TEST(Blobs, AreOfOneHueAndNotOfWhite) {
  Quads quads{40, 30, {}, {}, {}};
  for (auto* plane : {&quads.red, &quads.green, &quads.blue}) plane->assign(40 * 30, 10);
  const auto paint = [&](int left, int top, int r, int g, int b) {
    for (int y = top; y < top + 4; ++y) {
      for (int x = left; x < left + 5; ++x) {
        const auto at = static_cast<std::size_t>(40 * y + x);
        quads.red[at] = static_cast<std::int16_t>(r);
        quads.green[at] = static_cast<std::int16_t>(g);
        quads.blue[at] = static_cast<std::int16_t>(b);
      }
    }
  };
  paint(2, 2, 170, 40, 150);
  paint(12, 2, 250, 250, 250);
  paint(22, 2, 40, 170, 160);
  paint(30, 20, 160, 50, 150);
  const auto blobs = FindBlobs(quads, {0, 0, 39, 29}, {170, 40, 150}, 0.3);
  ASSERT_EQ(blobs.size(), 2u);
  EXPECT_EQ(blobs[0].area, 20);
  EXPECT_NEAR(blobs[0].centre.x(), 4, 1e-9);
  EXPECT_NEAR(blobs[1].centre.y(), 21.5, 1e-9);
}

}  // namespace
}  // namespace footing::sphere
