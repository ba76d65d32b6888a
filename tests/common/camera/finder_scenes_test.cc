// What surrounds a sphere, and how it moves, on frames of a renderer that shares no code with the
// finder.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "common/camera/find.h"
#include "common/virtual/camera/random_scene.h"
#include "common/virtual/camera/render.h"
#include "tests/common/camera/rendered.h"

namespace footing::sphere {
namespace {

namespace camera = virtual_camera;

camera::Scene SceneWith(const Eigen::Vector3d& p_C_m) {
  camera::Scene scene;
  scene.balls.resize(1);
  scene.balls[0].p_C_m = p_C_m;
  return scene;
}

class FinderScenes : public ::testing::Test {
 protected:
  std::optional<Estimate> Find(const camera::Scene& scene) {
    const auto mosaic = camera::Render(scene, random_);
    return finder_.Find(View(mosaic))[0];
  }

  noise::Random random_{41};
  Finder finder_{Lens(), {Target()}, Settings()};
};

TEST_F(FinderScenes, APlaceIsTheSameWhetherItWasForeseenOrNot) {
  Finder afresh(Lens(), {Target()}, Settings());
  camera::Scene scene = SceneWith({0, 0, 1.5});
  camera::AddClutter(scene, 25, random_);
  for (int i = 0; i < 12; ++i) {
    // 2 m/s to and fro, at 60 frames a second.
    const double phase = 2 * M_PI * i / 40, rate = 2 * M_PI * 60 / 40;
    scene.balls[0].p_C_m = {0.21 * std::sin(phase), 0.1 * std::cos(phase), 1.5};
    scene.balls[0].v_C_mps = {0.21 * rate * std::cos(phase), -0.1 * rate * std::sin(phase), 0};
    const auto mosaic = camera::Render(scene, random_);
    const auto followed = finder_.Find(View(mosaic))[0];
    afresh.Forget();
    const auto found = afresh.Find(View(mosaic))[0];
    ASSERT_TRUE(followed && found) << i;
    // Motion that is foreseen and motion that is found begin the fit differently.
    const double sd_m = std::sqrt(followed->covariance_m2.trace());
    EXPECT_LT((followed->p_C_m - found->p_C_m).norm(), 3 * sd_m) << i;
  }
}

TEST_F(FinderScenes, ASphereThatJumpsIsFoundAtOnce) {
  ASSERT_TRUE(Find(SceneWith({-0.4, 0.2, 1.5})));
  const auto found = Find(SceneWith({0.5, -0.3, 2}));
  ASSERT_TRUE(found);
  EXPECT_LT((found->p_C_m - Eigen::Vector3d(0.5, -0.3, 2)).norm(), 0.03);
  EXPECT_FALSE(Find(SceneWith({9, 0, 2})));
}

TEST_F(FinderScenes, ADullerThingOfItsHueThatTouchesItIsNoPartOfIt) {
  camera::Scene scene = SceneWith({0, 0, 1.5});
  const Eigen::Vector2d at = camera::Project(scene.lens, scene.balls[0].p_C_m);
  // Its hue, and 0.6 of its brightness.
  scene.shapes.push_back({camera::Shape::Kind::kRectangle,
                          at + Eigen::Vector2d(30, 0),
                          {28, 22},
                          0.2,
                          0.6 * scene.balls[0].colour_dn});
  const auto found = Find(scene);
  ASSERT_TRUE(found);
  EXPECT_LT((found->centre_px - at).norm(), 0.5);
  EXPECT_LT(std::abs(found->p_C_m.norm() - 1.5), 0.06);
}

TEST_F(FinderScenes, ASphereInFrontOfALampIsSeen) {
  camera::Scene scene = SceneWith({0.1, 0.1, 1.2});
  const Eigen::Vector2d at = camera::Project(scene.lens, scene.balls[0].p_C_m);
  scene.shapes.push_back({camera::Shape::Kind::kEllipse, at, {25, 25}, 0, {400, 400, 400}});
  const auto found = Find(scene);
  ASSERT_TRUE(found);
  EXPECT_LT((found->centre_px - at).norm(), 0.5);
}

TEST_F(FinderScenes, ASmallSphereBeforeTheEdgeOfALampIsSeen) {
  camera::Scene scene = SceneWith({0.1, 0.1, 3});
  const Eigen::Vector2d at = camera::Project(scene.lens, scene.balls[0].p_C_m);
  int by_edge = 0;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * M_PI * i / 12;
    scene.shapes = {{camera::Shape::Kind::kEllipse,
                     at + 20 * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                     {20, 20},
                     0,
                     {400, 400, 400}}};
    finder_.Forget();
    const auto found = Find(scene);
    ASSERT_TRUE(found) << i;
    EXPECT_LT((found->centre_px - at).norm(), 2) << i;
    EXPECT_NEAR(found->p_C_m.norm(), 3, 0.6) << i;
    if (!found->is_by_edge) continue;
    // Nothing explains its light: its distance is rough, and it says so.
    ++by_edge;
    EXPECT_LT(found->confidence, 0.21) << i;
    const Eigen::Vector3d along = found->p_C_m.normalized();
    EXPECT_GT(std::sqrt(along.dot(found->covariance_m2 * along)), 0.15) << i;
  }
  EXPECT_GT(by_edge, 0);
}

TEST_F(FinderScenes, ASphereThatALampTouchesIsNotTakenForTheLamp) {
  // The sphere is half before the lamp, so that it had the size of the lamp's outline, or wholly.
  // The lamp is brighter than the sensor's limit by 1.2 to 8 times.
  constexpr double kBlurPx = 0.9;
  struct Case {
    double range_m, apart_px;
    std::vector<double> lamps_dn;
  };
  for (const Case& one :
       {Case{1.4, 20, {300, 2000}}, Case{1.4, 12, {300, 2000}}, Case{3.2, 8, {300, 400}}}) {
    camera::Scene scene = SceneWith({0.1, 0.1, one.range_m});
    const Eigen::Vector2d at = camera::Project(scene.lens, scene.balls[0].p_C_m);
    for (const double lamp_dn : one.lamps_dn) {
      for (int i = 0; i < 6; ++i) {
        const double angle = 2 * M_PI * (i + 0.3) / 6;
        scene.shapes = {{camera::Shape::Kind::kEllipse,
                         at + one.apart_px * Eigen::Vector2d(std::cos(angle), std::sin(angle)),
                         {20, 20},
                         0,
                         Eigen::Vector3d::Constant(lamp_dn)}};
        finder_.Forget();
        const auto found = Find(scene);
        ASSERT_TRUE(found) << lamp_dn << ' ' << i;
        EXPECT_LT((found->centre_px - at).norm(), 2 * kBlurPx) << lamp_dn << ' ' << i;
        EXPECT_NEAR(found->p_C_m.norm(), scene.balls[0].p_C_m.norm(), 0.25 * one.range_m)
            << lamp_dn << ' ' << i;
      }
    }
  }
}

TEST_F(FinderScenes, ADullDiscOfItsHueIsNoSphere) {
  camera::Scene scene = SceneWith({9, 0, 2});
  for (const double share : {0.3, 0.5, 0.6}) {
    scene.shapes = {
        {camera::Shape::Kind::kEllipse, {300, 200}, {9, 9}, 0, share * scene.balls[0].colour_dn}};
    const auto found = Find(scene);
    EXPECT_LT(found ? found->confidence : 0, 0.5) << share;
  }
}

}  // namespace
}  // namespace footing::sphere
