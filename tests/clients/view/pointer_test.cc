#include "clients/view/scene/pointer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "clients/view/scene/stage.h"

namespace footing::scene {
namespace {

constexpr double kAspect = 16.0 / 9;

Camera FromBehind() {
  Camera camera;
  camera.eye_m = {-4, 1, 2.2};
  camera.target_m = {1, -0.3, 1};
  return camera;
}

/// Place of a point in the picture, heights from the upper left corner, y down.
Eigen::Vector2d PlaceOf(const Camera& camera, const Eigen::Vector3d& p_m) {
  const Eigen::Vector3f p = p_m.cast<float>();
  const Eigen::Vector4f clip = camera.Projection(kAspect) * camera.View() * p.homogeneous();
  return {0.5 * kAspect * (1 + static_cast<double>(clip.x() / clip.w())),
          0.5 * (1 - static_cast<double>(clip.y() / clip.w()))};
}

CharacterPose StandingAt(std::uint32_t character, double x_m, double y_m) {
  CharacterPose pose;
  pose.character = character;
  pose.valid = true;
  pose.com_m = {x_m, y_m, 0.95};
  return pose;
}

const CharacterPose* Under(const WorldFrame& frame, const Eigen::Vector3d& p_m) {
  return CharacterAt(frame, RayThrough(FromBehind(), kAspect, PlaceOf(FromBehind(), p_m)));
}

TEST(Pointer, TheRayGoesThroughWhatTheMouseIsOn) {
  for (const Eigen::Vector3d& p_m :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, -1.5, 1), Eigen::Vector3d(5, 2, 0.3)}) {
    const Ray ray = RayThrough(FromBehind(), kAspect, PlaceOf(FromBehind(), p_m));
    const Eigen::Vector3d to_m = p_m - ray.from_m;
    EXPECT_NEAR(to_m.cross(ray.direction).norm(), 0, 1e-4) << p_m.transpose();
    EXPECT_GT(to_m.dot(ray.direction), 0);
  }
}

TEST(Pointer, ACharacterIsHitFromTheFeetToTheHeadAndNotBesideIt) {
  WorldFrame frame;
  frame.characters = {StandingAt(7, 0, 0)};
  for (const double height_m : {0.05, 0.95, 1.85}) {
    const CharacterPose* const hit = Under(frame, {0, 0, height_m});
    ASSERT_NE(hit, nullptr) << height_m;
    EXPECT_EQ(hit->character, 7u);
  }
  EXPECT_EQ(Under(frame, {0, 0.8, 0.95}), nullptr);
  EXPECT_EQ(Under(frame, {0, 0, 2.6}), nullptr);
  // Straight up from the eye there is nothing; behind it neither.
  EXPECT_EQ(CharacterAt(frame, {{0, 0, 5}, Eigen::Vector3d::UnitZ()}), nullptr);
  EXPECT_EQ(CharacterAt(frame, {{-3, 0, 1}, -Eigen::Vector3d::UnitX()}), nullptr);
  frame.characters[0].valid = false;
  EXPECT_EQ(Under(frame, {0, 0, 0.95}), nullptr);
}

TEST(Pointer, OfTwoBehindEachOtherTheNearerOneIsHit) {
  WorldFrame frame;
  const Eigen::Vector3d away_m = Eigen::Vector3d(0, 0, 0.95) - FromBehind().eye_m;
  frame.characters = {StandingAt(1, 0.4 * away_m.x(), 0.4 * away_m.y()), StandingAt(2, 0, 0)};
  const CharacterPose* const hit = Under(frame, {0, 0, 0.95});
  ASSERT_NE(hit, nullptr);
  EXPECT_EQ(hit->character, 2u);
}

TEST(PushDrag, GoesAlongTheGroundAsTheHandGoesOverThePicture) {
  const CharacterPose pose = StandingAt(3, 0, 0);
  const Camera camera = FromBehind();
  const Eigen::Vector2d ahead = (camera.target_m - camera.eye_m).head<2>().normalized();
  const auto up = PushOf(camera, pose, {0, -0.1});
  ASSERT_TRUE(up);
  EXPECT_EQ(up->character, 3u);
  EXPECT_NEAR(up->impulse_W_ns.normalized().dot(ahead), 1, 1e-12);
  const auto right = PushOf(camera, pose, {0.1, 0});
  ASSERT_TRUE(right);
  EXPECT_NEAR(right->impulse_W_ns.normalized().dot(Eigen::Vector2d(ahead.y(), -ahead.x())), 1,
              1e-12);
  // At 4.3 m a picture with a field of 0.8 rad is 3.66 m high: a tenth of it at 20 N s a metre.
  const double range_m = (pose.com_m - camera.eye_m).norm();
  EXPECT_NEAR(right->impulse_W_ns.norm(), 0.1 * 2 * range_m * std::tan(0.4) * 20, 1e-9);
}

TEST(PushDrag, AClickPushesNothingAndALongDragNoHarderThanTheLimit) {
  const CharacterPose pose = StandingAt(1, 0, 0);
  EXPECT_FALSE(PushOf(FromBehind(), pose, {0, 0}));
  EXPECT_FALSE(PushOf(FromBehind(), pose, {0.003, 0}));
  const auto longest = PushOf(FromBehind(), pose, {30, 40});
  ASSERT_TRUE(longest);
  EXPECT_NEAR(longest->impulse_W_ns.norm(), kMostPushNs, 1e-9);
  EXPECT_FALSE(PushOf(FromBehind(), pose, {std::nan(""), 0}));
}

TEST(PushDrag, TheArrowLeadsFromTheComAsFarAsTheHandWentAndNamesTheImpulse) {
  WorldFrame frame;
  frame.characters = {StandingAt(1, 2, 0)};
  Picture picture;
  AddPush(frame, {1, {30, -40}}, picture);
  ASSERT_EQ(picture.labels.size(), 1u);
  EXPECT_EQ(picture.labels[0].text, "50 N s");
  // 50 N s at 20 N s a metre are 2.5 m.
  EXPECT_NEAR((picture.labels[0].at_m - Eigen::Vector3f(3.5f, -2, 0.95f)).norm(), 0, 1e-5);
  EXPECT_EQ(picture.signs.rods.size(), 2u);
  AddPush(frame, {9, {30, -40}}, picture);
  EXPECT_EQ(picture.labels.size(), 1u) << "there is no such character";
}

TEST(TimeWindow, TheInstantUnderTheMouseStaysWhereItIs) {
  const auto age_at = [](const TimeWindow& window, double share) {
    return window.age_s + (1 - share) * window.span_s;
  };
  TimeWindow window;
  for (const double share : {0.2, 0.7, 0.5}) {
    const double before_s = age_at(window, share);
    window = Zoomed(window, 2, share);
    EXPECT_NEAR(age_at(window, share), before_s, 1e-9);
  }
  EXPECT_LT(window.span_s, 4);
  // Out again, it ends at the whole strip.
  window = Zoomed(window, -100, 0.1);
  EXPECT_EQ(window.span_s, TimeWindow::kLongestS);
  EXPECT_EQ(window.age_s, 0);
}

TEST(TimeWindow, StaysWithinTheCurves) {
  TimeWindow window = Zoomed({}, 100, 0.5);
  EXPECT_EQ(window.span_s, TimeWindow::kShortestS);
  window = Dragged(window, 0.5);
  EXPECT_NEAR(window.age_s, 4.9 + 0.1, 1e-9);
  EXPECT_NEAR(Dragged(window, 1e6).age_s, 10 - 0.2, 1e-9);
  EXPECT_EQ(Dragged(window, -1e6).age_s, 0);
}

}  // namespace
}  // namespace footing::scene
