#include "clients/view/scene/clear_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "clients/view/scene/ribbon.h"
#include "common/base/units.h"

namespace footing::scene {
namespace {

/// A track along x that falls by 10 degrees, then goes on level; the bird is at its foot.
stream::Track Downhill() {
  stream::Track track;
  track.segments = {{{-30, 0, 30 * std::tan(DegreesToRadians(10))},
                     0,
                     DegreesToRadians(-10),
                     30 / std::cos(DegreesToRadians(10)),
                     4,
                     false},
                    {{0, 0, 0}, 0, 0, 30, 4, false}};
  return track;
}

Picture AtTheFoot() {
  Picture picture;
  picture.camera.pivot_m = Eigen::Vector3d(0, 0, 1);
  picture.camera.eye_m = {-4.5, 0.5, 2.5};
  picture.camera.target_m = {1.2, 0, 1.2};
  picture.spots = {{{0, 0, 0}, {0, 0}}};
  picture.ground_m = -0.03f;
  return picture;
}

TEST(ClearView, TheUsualViewIsAsItWas) {
  const Picture picture = AtTheFoot();
  const Camera camera = ClearView(picture, Downhill(), {});
  EXPECT_EQ(camera.eye_m, picture.camera.eye_m);
  EXPECT_EQ(camera.target_m, picture.camera.target_m);
}

TEST(ClearView, TheEyeStaysOverAHillAtEveryZoomAndTurn) {
  const Picture picture = AtTheFoot();
  const stream::Track track = Downhill();
  for (double distance = 0.25; distance <= 6; distance *= 1.1) {
    for (int degrees = -180; degrees < 180; degrees += 15) {
      for (const double elevation_rad : {-1.5, -0.3, 0.0, 1.0}) {
        const Camera camera =
            ClearView(picture, track, {DegreesToRadians(degrees), elevation_rad, distance});
        const double floor_m = HeightAt(track, camera.eye_m.head<2>(), -0.03);
        ASSERT_GT(camera.eye_m.z() - floor_m, 0.3) << distance << " " << degrees;
      }
    }
  }
}

TEST(ClearView, NothingOfTheHillIsBeforeTheBird) {
  const Picture picture = AtTheFoot();
  const stream::Track track = Downhill();
  const Orbit low{.elevation_rad = -0.5, .distance = 4};
  const Camera camera = ClearView(picture, track, low);
  ASSERT_GT(camera.eye_m.z(), Orbited(picture.camera, low).eye_m.z()) << "it had to rise";
  for (double share = 0; share < 0.75; share += 0.01) {
    const Eigen::Vector3d p_m = camera.eye_m + share * (*camera.pivot_m - camera.eye_m);
    EXPECT_GT(p_m.z(), HeightAt(track, p_m.head<2>(), -0.03)) << share;
  }
}

TEST(ClearView, TheEyeRisesWithoutAJumpAsTheViewTurns) {
  const Picture picture = AtTheFoot();
  const stream::Track track = Downhill();
  double before_m = ClearView(picture, track, {.elevation_rad = 0.4, .distance = 4}).eye_m.z();
  for (double elevation_rad = 0.4; elevation_rad > -0.6; elevation_rad -= 0.002) {
    const double eye_m =
        ClearView(picture, track, {.elevation_rad = elevation_rad, .distance = 4}).eye_m.z();
    EXPECT_NEAR(eye_m, before_m, 0.06) << elevation_rad;
    before_m = eye_m;
  }
}

TEST(ClearView, AFigureThatWalksIntoTheEyeIsKeptAtItsReach) {
  Picture picture = AtTheFoot();
  picture.camera.pivot_m.reset();
  for (double x_m = -6; x_m < 0; x_m += 0.1) {
    picture.spots[0].centre_m.x() = static_cast<float>(x_m);
    picture.camera.eye_m = {-2, 0.2, 1.2};
    const Eigen::Vector3d eye_m = ClearView(picture, {}, {}).eye_m;
    // Level with the chest the capsule around the figure is an upright cylinder, but for its dome.
    const Eigen::Vector3d axis_m(x_m, 0, std::min(eye_m.z(), kFigureHeightM - kFigureReachM));
    EXPECT_GE((eye_m - axis_m).norm(), kFigureReachM - 1e-6) << x_m;
  }
}

}  // namespace
}  // namespace footing::scene
