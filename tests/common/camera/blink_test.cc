// The switching of a light on frames of a renderer that shares no code with the finder.
#include "common/camera/image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/virtual/camera/render.h"
#include "common/virtual/camera/scene.h"
#include "tests/common/camera/rendered.h"

namespace footing::sphere {
namespace {

namespace camera = virtual_camera;
using ::testing::HasSubstr;

const Eigen::Vector3d kUnlit(16, 15, 17), kLit(150, 40, 130);

class BlinkTest : public ::testing::Test {
 protected:
  BlinkTest() {
    camera::Ball ball;
    ball.p_C_m = {0.2, -0.1, 0.9};
    scene_.balls = {ball};
    camera::AddClutter(scene_, 30, random_);
  }

  /// Mean of six frames with the ball in that colour.
  MeanImage Frames(const Eigen::Vector3d& colour_dn) {
    scene_.balls[0].colour_dn = colour_dn;
    MeanImage mean;
    for (const auto& mosaic : camera::RenderStill(scene_, 6, random_)) mean.Add(View(mosaic));
    return mean;
  }

  Result<Blink> Find(const Eigen::Vector3d& lit_dn) {
    MeanImage dark = Frames(kUnlit), lit = Frames(lit_dn);
    return FindBlink(dark.View(), lit.View());
  }

  noise::Random random_{31};
  camera::Scene scene_;
};

TEST_F(BlinkTest, FindsTheSphereAndItsColourInClutter) {
  const auto blink = Find(kLit);
  ASSERT_TRUE(blink) << blink.error().message;
  EXPECT_LT((blink->centre_px - camera::Project(scene_.lens, scene_.balls[0].p_C_m)).norm(), 1);
  EXPECT_NEAR(blink->radius_px, 540 * 0.0225 / 0.9, 1.5);
  // Its middle, where limb darkening takes at most 0.15 (1 - cos(asin 0.6)) = 3 % and the hot spot
  // adds or takes 6 %.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(blink->colour_dn[i] / kLit[i], 0.985, 0.03) << i;
  EXPECT_EQ(blink->clipped_share, 0);
}

TEST_F(BlinkTest, SaysWhenNothingLightsUp) {
  const auto blink = Find(kUnlit);
  ASSERT_FALSE(blink);
  EXPECT_THAT(blink.error().message, HasSubstr("nothing lights up"));
}

TEST_F(BlinkTest, SaysWhenAnotherLightChanges) {
  MeanImage dark = Frames(kUnlit);
  scene_.shapes.push_back({camera::Shape::Kind::kEllipse, {100, 400}, {14, 14}, 0, {0, 180, 60}});
  MeanImage lit = Frames(kLit);
  const auto blink = FindBlink(dark.View(), lit.View());
  ASSERT_FALSE(blink);
  EXPECT_THAT(blink.error().message, HasSubstr("two places"));
}

TEST_F(BlinkTest, SaysWhenHalfOfItIsHidden) {
  scene_.occluders = {{camera::Project(scene_.lens, scene_.balls[0].p_C_m), {1, 0}}};
  const auto blink = Find(kLit);
  ASSERT_FALSE(blink);
  EXPECT_THAT(blink.error().message, HasSubstr("not round"));
}

TEST_F(BlinkTest, ReportsLightAtTheLimit) {
  const auto blink = Find({400, 90, 300});
  ASSERT_TRUE(blink) << blink.error().message;
  EXPECT_GT(blink->clipped_share, 0.3);
}

}  // namespace
}  // namespace footing::sphere
