// Lens calibration on rendered sheets of dots; the renderer shares no code with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/camera/fit_lens.h"
#include "common/virtual/camera/scene.h"

namespace footing::lens_calibration {
namespace {

namespace camera = virtual_camera;
using ::testing::HasSubstr;

const camera::Lens kTruth{640, 480, 545, 549, 326, 233, -0.12, 0.03, 0.001, -0.0007, 0};

/// A sheet at a place of the picture, tilted about both its axes.
camera::DotSheet SheetAt(const Eigen::Vector2d& pixel, double depth_m, double about_x,
                         double about_y) {
  camera::DotSheet sheet;
  const Eigen::Vector3d ray = camera::RayThrough(kTruth, pixel);
  sheet.X_CS.translation() = ray * (depth_m / ray.z());
  sheet.X_CS.linear() = (Eigen::AngleAxisd(about_x, Eigen::Vector3d::UnitX()) *
                         Eigen::AngleAxisd(about_y, Eigen::Vector3d::UnitY()))
                            .toRotationMatrix();
  return sheet;
}

View Seen(const camera::DotSheet& sheet, noise::Random& random) {
  camera::Scene scene;
  scene.lens = kTruth;
  const auto mosaic = camera::RenderSheet(scene, sheet, random);
  return FindDotGrid({sphere::PixelFormat::kSgrbg8, mosaic.width, mosaic.height, mosaic.bytes});
}

/// Views all over the picture; `tilt` is the largest angle.
std::vector<View> Views(int count, double tilt, noise::Random& random) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(160 + 160 * (i % 3), 130 + 110 * (i / 3 % 3));
    views.push_back(Seen(SheetAt(pixel, random.Uniform(0.35, 0.5), random.Uniform(-tilt, tilt),
                                 random.Uniform(-tilt, tilt)),
                         random));
  }
  return views;
}

TEST(DotGrid, FindsEveryDotToATenthOfAPixel) {
  noise::Random random(3);
  const camera::DotSheet sheet = SheetAt({320, 240}, 0.45, 0.3, -0.4);
  const View dots = Seen(sheet, random);
  ASSERT_EQ(dots.size(), 13u * 9);
  // The first dot has number (0, 0): columns and rows from there, up to how the sheet is turned.
  Eigen::Vector2i least(99, 99), most(-99, -99);
  double worst = 0;
  for (const GridDot& dot : dots) {
    least = least.cwiseMin(dot.at);
    most = most.cwiseMax(dot.at);
    double off = 1e9;
    for (int i = 0; i < 13 * 9; ++i) {
      const Eigen::Vector3d at(sheet.pitch_m * (i % 13 - 6), sheet.pitch_m * (i / 13 - 4), 0);
      off = std::min(off, (camera::Project(kTruth, sheet.X_CS * at) - dot.pixel).norm());
    }
    worst = std::max(worst, off);
  }
  EXPECT_EQ(std::max(most.x() - least.x(), most.y() - least.y()), 12);
  EXPECT_EQ(std::min(most.x() - least.x(), most.y() - least.y()), 8);
  EXPECT_LT(worst, 0.1);
}

TEST(DotGrid, IsNothingWhereThereAreNoDots) {
  noise::Random random(4);
  camera::DotSheet sheet = SheetAt({320, 240}, 0.45, 0, 0);
  sheet.ink_dn = sheet.paper_dn;
  EXPECT_TRUE(Seen(sheet, random).empty());
}

TEST(FitLens, FindsTheTrueLens) {
  noise::Random random(5);
  const auto fit = FitLens(Views(12, 0.6, random), 640, 480);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_LT(fit->rms_px, 0.3);
  EXPECT_NEAR(fit->lens.fx_px, kTruth.fx_px, 1.5);
  EXPECT_NEAR(fit->lens.fy_px, kTruth.fy_px, 1.5);
  EXPECT_NEAR(fit->lens.cx_px, kTruth.cx_px, 1.5);
  EXPECT_NEAR(fit->lens.cy_px, kTruth.cy_px, 1.5);
  EXPECT_LT(std::abs(fit->lens.fx_px - kTruth.fx_px), 5 * fit->focal_sd_px + 0.3);
  // The criterion is where a ray appears: everywhere in the picture within half a pixel.
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(20, 20), Eigen::Vector2d(620, 20),
                                       Eigen::Vector2d(320, 240), Eigen::Vector2d(620, 460)}) {
    const Eigen::Vector3d ray = camera::RayThrough(kTruth, pixel);
    EXPECT_LT((sphere::ToPixel(fit->lens, ray.head<2>() / ray.z()) - pixel).norm(), 0.5)
        << pixel.transpose();
  }
}

TEST(FitLens, RefusesASheetThatIsNeverTilted) {
  noise::Random random(6);
  const auto fit = FitLens(Views(9, 0.01, random), 640, 480);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("tilt"));
}

TEST(FitLens, RefusesFewViewsAndAPictureThatIsNotCovered) {
  noise::Random random(7);
  const std::vector<View> views = Views(6, 0.6, random);
  EXPECT_THAT(FitLens({views[0], views[1]}, 640, 480).error().message, HasSubstr("6 are needed"));
  const std::vector<View> same(7, Seen(SheetAt({320, 240}, 0.9, 0.4, 0.2), random));
  EXPECT_THAT(FitLens(same, 640, 480).error().message, HasSubstr("bring the sheet to its edges"));
}

TEST(FitLens, RefusesDotsThatAreNotFlat) {
  noise::Random random(8);
  std::vector<View> views = Views(9, 0.6, random);
  for (View& view : views)
    for (GridDot& dot : view) dot.pixel.y() += 3 * std::sin(0.7 * dot.at.x());
  const auto fit = FitLens(views, 640, 480);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("keep the sheet flat"));
}

}  // namespace
}  // namespace footing::lens_calibration
