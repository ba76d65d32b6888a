#include "clients/view/scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr double kStepS = 1.0 / 60;

Subject At(double x_m, double heading_rad, double speed_mps) {
  Subject subject;
  subject.position_m = {x_m, 0, 1};
  subject.heading_rad = heading_rad;
  subject.speed_mps = speed_mps;
  return subject;
}

ChaseCamera Settled(double heading_rad, double speed_mps) {
  ChaseCamera camera;
  for (int i = 0; i < 600; ++i) {
    camera.Advance(At(speed_mps * kStepS * i, heading_rad, speed_mps), kStepS);
  }
  return camera;
}

Eigen::Vector4f Clip(const Camera& camera, const Eigen::Vector3d& p_m) {
  const Eigen::Vector4f p(static_cast<float>(p_m.x()), static_cast<float>(p_m.y()),
                          static_cast<float>(p_m.z()), 1);
  return camera.Projection(16.0 / 9) * camera.View() * p;
}

TEST(Camera, WhatItLooksAtIsInTheMiddleOfThePicture) {
  Camera camera;
  camera.eye_m = {-4, 1, 2};
  camera.target_m = {3, -1, 0.5};
  const Eigen::Vector4f clip = Clip(camera, camera.target_m);
  EXPECT_NEAR(clip.x() / clip.w(), 0, 1e-5);
  EXPECT_NEAR(clip.y() / clip.w(), 0, 1e-5);
  EXPECT_GT(clip.w(), 0);
}

TEST(Camera, ARollTurnsThePictureClockwise) {
  Camera camera;
  camera.eye_m = {0, 0, 1};
  camera.target_m = {5, 0, 1};
  camera.roll_rad = DegreesToRadians(20);
  const Eigen::Vector4f above = Clip(camera, {5, 0, 2});
  // An upright thing leans to the right.
  EXPECT_NEAR(std::atan2(above.x() * 16 / 9, above.y()), DegreesToRadians(20), 1e-4);
}

TEST(Camera, NeverRolls) {
  for (const double heading_rad : {-3.0, -1.0, 0.0, 0.5, 2.0}) {
    const Eigen::Matrix4f view = Settled(heading_rad, 2).Look().View();
    // The camera's right axis is level.
    EXPECT_NEAR(view(0, 2), 0, 1e-6);
    EXPECT_GT(view(1, 2), 0);
  }
}

TEST(ChaseCamera, StandsFourAndAHalfMetresBehindAndOneAndAHalfAbove) {
  const Camera camera = Settled(0, 0).Look();
  EXPECT_NEAR(camera.eye_m.x(), -4.5, 1e-6);
  EXPECT_NEAR(camera.eye_m.z(), 1 + 1.5, 1e-6);
}

TEST(ChaseCamera, KeepsItsDistanceAtASteadySpeed) {
  const double last_x_m = 3 * kStepS * 599;
  EXPECT_NEAR(Settled(0, 3).Look().eye_m.x(), last_x_m - 4.5, 0.1);
}

TEST(ChaseCamera, LooksFurtherAheadTheFasterItsSubject) {
  const Camera slow = Settled(0, 0).Look();
  const Camera fast = Settled(0, 3).Look();
  const double slow_ahead_m = slow.target_m.x() - slow.eye_m.x();
  const double fast_ahead_m = fast.target_m.x() - fast.eye_m.x();
  EXPECT_GT(fast_ahead_m, slow_ahead_m + 0.5);
}

TEST(ChaseCamera, TurnsTheShortWayAndWithoutOvershoot) {
  ChaseCamera camera = Settled(DegreesToRadians(170), 0);
  double before_rad = DegreesToRadians(170);
  for (int i = 0; i < 300; ++i) {
    camera.Advance(At(0, DegreesToRadians(-170), 0), kStepS);
    const Camera look = camera.Look();
    const Eigen::Vector3d behind = look.eye_m - Eigen::Vector3d(0, 0, look.eye_m.z());
    // The eye is behind by 4.5 m and aside by a fixed angle: its bearing turns with the heading.
    const double bearing_rad = std::atan2(-behind.y(), -behind.x());
    const double turned_rad = WrapAngle(bearing_rad - before_rad);
    if (i > 0) {
      EXPECT_GE(turned_rad, -1e-9);
    }
    EXPECT_LT(std::abs(turned_rad), DegreesToRadians(i == 0 ? 30 : 5));
    before_rad = bearing_rad;
  }
}

TEST(ChaseCamera, JumpsWithASubjectThatWasPutBack) {
  ChaseCamera camera = Settled(0, 0);
  camera.Advance(At(-10, 0, 0), kStepS);
  EXPECT_NEAR(camera.Look().eye_m.x(), -14.5, 1e-6);
}

TEST(ChaseCamera, ALongPauseDoesNotThrowItOff) {
  ChaseCamera camera = Settled(0, 0);
  camera.Advance(At(0.5, 0, 0), 30);
  camera.Advance(At(0.5, 0, 0), 0);
  for (int i = 0; i < 300; ++i) camera.Advance(At(0.5, 0, 0), kStepS);
  EXPECT_NEAR(camera.Look().eye_m.x(), 0.5 - 4.5, 1e-3);
}

double YawOf(const Camera& camera) {
  const Eigen::Vector3d way_m = camera.target_m - camera.eye_m;
  return std::atan2(way_m.y(), way_m.x());
}

/// Yaw of the view in a curve at 3 m/s, less that of a straight way: the command comes at 0 s, the
/// heading follows from 0.4 s on, and both end at 4 s.
std::vector<double> YawsInACurve(double turn_radps) {
  ChaseCamera camera = Settled(0, 3);
  const double straight_rad = YawOf(camera.Look());
  Subject subject = At(3 * kStepS * 599, 0, 3);
  std::vector<double> yaws_rad;
  for (double t_s = 0; t_s < 8; t_s += kStepS) {
    subject.turn_radps = t_s < 4 ? turn_radps : 0;
    if (t_s >= 0.4 && t_s < 4) subject.heading_rad += turn_radps * kStepS;
    subject.position_m.head<2>() +=
        3 * kStepS * Eigen::Vector2d(std::cos(subject.heading_rad), std::sin(subject.heading_rad));
    camera.Advance(subject, kStepS);
    yaws_rad.push_back(WrapAngle(YawOf(camera.Look()) - straight_rad));
  }
  return yaws_rad;
}

double At(const std::vector<double>& curve, double t_s) {
  return curve[static_cast<std::size_t>(t_s / kStepS)];
}

TEST(ChaseCamera, LooksIntoACurveBeforeItsSubjectTurns) {
  for (const double turn_radps : {0.4, -0.4}) {
    const std::vector<double> yaws_rad = YawsInACurve(turn_radps);
    const double side = turn_radps > 0 ? 1 : -1;
    EXPECT_GT(side * At(yaws_rad, 0.4), DegreesToRadians(3)) << "the heading is still straight";
    // In the curve it looks ahead of the heading by what the subject turns within 0.8 s.
    const double heading_rad = 0.4 * (3.5 - 0.4);
    EXPECT_NEAR(side * At(yaws_rad, 3.5), heading_rad + 0.8 * 0.4, 0.06);
    EXPECT_NEAR(side * At(yaws_rad, 7.9), 0.4 * 3.6, 0.01) << "and then straight on";
  }
}

TEST(ChaseCamera, TurnsWithoutAJerkAndSwingsBackByLittle) {
  const std::vector<double> yaws_rad = YawsInACurve(0.4);
  double fastest_radps = 0, most_radps2 = 0, back_rad = 0, farthest_rad = 0;
  for (std::size_t i = 2; i < yaws_rad.size(); ++i) {
    const double rate = (yaws_rad[i] - yaws_rad[i - 1]) / kStepS;
    const double before = (yaws_rad[i - 1] - yaws_rad[i - 2]) / kStepS;
    fastest_radps = std::max(fastest_radps, std::abs(rate));
    most_radps2 = std::max(most_radps2, std::abs(rate - before) / kStepS);
    farthest_rad = std::max(farthest_rad, yaws_rad[i]);
  }
  back_rad = farthest_rad - yaws_rad.back();
  EXPECT_LT(fastest_radps, 2 * 0.4);
  EXPECT_LT(most_radps2, 4);
  // It swings back by as much as it looked ahead, and little more.
  EXPECT_LT(back_rad, 0.8 * 0.4 + DegreesToRadians(5));
}

TEST(ChaseCamera, StandsStillInHeightWhileItsSubjectJumps) {
  Subject subject = At(0, 0, 0);
  subject.support_m = 0;
  ChaseCamera camera;
  camera.Advance(subject, kStepS);
  const double eye_m = camera.Look().eye_m.z();
  for (double t_s = 0; t_s < 3; t_s += kStepS) {
    // Hops of 0.5 m and 0.64 s, 0.2 s apart, in which the hips dip.
    const double phase_s = std::fmod(t_s, 0.84), rise_m = 9.81 / 2 * phase_s * (0.64 - phase_s);
    subject.position_m.z() = phase_s < 0.64 ? 0.95 + rise_m : 0.85;
    subject.support_m = phase_s < 0.64 ? std::nullopt : std::optional(0.0);
    camera.Advance(subject, kStepS);
    EXPECT_NEAR(camera.Look().eye_m.z(), eye_m, 1e-9) << t_s;
  }
}

TEST(ChaseCamera, EasesToTheHeightThatItsSubjectLandsOn) {
  Subject subject = At(0, 0, 0);
  subject.support_m = 0;
  ChaseCamera camera;
  camera.Advance(subject, kStepS);
  subject.support_m = 0.3;
  double before_m = camera.Look().eye_m.z(), fastest_mps = 0;
  const double begin_m = before_m;
  for (double t_s = 0; t_s < 3; t_s += kStepS) {
    camera.Advance(subject, kStepS);
    const double eye_m = camera.Look().eye_m.z();
    EXPECT_GE(eye_m, before_m - 1e-9);
    fastest_mps = std::max(fastest_mps, (eye_m - before_m) / kStepS);
    before_m = eye_m;
  }
  EXPECT_NEAR(before_m - begin_m, 0.3, 0.01);
  // A critically damped step of h is fastest at 1/w, with w h / e.
  EXPECT_NEAR(fastest_mps, 2.5 * 0.3 / std::exp(1), 0.01);
}

Camera Behind() {
  Camera camera;
  camera.eye_m = {-4, 1, 2.5};
  camera.target_m = {1, 0, 1};
  camera.pivot_m = Eigen::Vector3d(0, 0, 1);
  return camera;
}

TEST(Orbit, WithoutATurnTheViewIsAsItWas) {
  const Camera camera = Orbited(Behind(), {});
  EXPECT_NEAR((camera.eye_m - Behind().eye_m).norm(), 0, 1e-12);
  EXPECT_NEAR((camera.target_m - Behind().target_m).norm(), 0, 1e-12);
}

TEST(Orbit, AQuarterTurnGoesAroundThePivotWhichStaysInItsPlace) {
  const Camera turned = Orbited(Behind(), {.azimuth_rad = kPi / 2});
  // (-4, 1) turned by 90 degrees is (-1, -4).
  EXPECT_NEAR((turned.eye_m - Eigen::Vector3d(-1, -4, 2.5)).norm(), 0, 1e-12);
  const Eigen::Vector4f before = Clip(Behind(), *Behind().pivot_m);
  const Eigen::Vector4f after = Clip(turned, *Behind().pivot_m);
  EXPECT_NEAR(after.x() / after.w(), before.x() / before.w(), 1e-5);
  EXPECT_NEAR(after.y() / after.w(), before.y() / before.w(), 1e-5);
}

TEST(Orbit, TheWheelChangesTheDistanceAndNothingElse) {
  const Camera near = Orbited(Behind(), {.distance = 0.5});
  EXPECT_NEAR((near.eye_m - Eigen::Vector3d(-2, 0.5, 1.75)).norm(), 0, 1e-12);
}

TEST(Orbit, TheEyeStaysOverTheGroundAndIsNeverOverhead) {
  const Camera low = Orbited(Behind(), {.elevation_rad = -kPi / 2, .distance = 6});
  EXPECT_GT(low.eye_m.z(), 0.3);
  const Camera high = Orbited(Behind(), {.elevation_rad = kPi / 2});
  EXPECT_GT(high.eye_m.head<2>().norm(), 0.5);
  EXPECT_GT(high.eye_m.z(), 5);
}

TEST(Orbit, AShiftMovesThePivotInThePictureByThatMuchAtEveryZoomAndTurn) {
  for (const double azimuth_rad : {0.0, 1.1}) {
    for (const double distance : {0.5, 2.0}) {
      Orbit orbit{.azimuth_rad = azimuth_rad, .elevation_rad = 0.3, .distance = distance};
      const Eigen::Vector4f before = Clip(Orbited(Behind(), orbit), *Behind().pivot_m);
      orbit.shift = {0.2, 0.1};
      const Eigen::Vector4f after = Clip(Orbited(Behind(), orbit), *Behind().pivot_m);
      // Clip space is 2 high and 2 * 16 / 9 wide, y up.
      EXPECT_NEAR(after.x() / after.w() - before.x() / before.w(), 0.2 * 2 * 9 / 16, 0.03);
      EXPECT_NEAR(after.y() / after.w() - before.y() / before.w(), -0.1 * 2, 0.03);
    }
  }
}

TEST(Orbit, AShiftUpwardsDoesNotTakeTheEyeUnderTheGround) {
  const Camera low = Orbited(Behind(), {.elevation_rad = -0.4, .shift = {0, -1.5}});
  EXPECT_GT(low.eye_m.z(), 0.3);
}

TEST(MouseOrbit, ADragTurnsOrShiftsAndEnds) {
  using Drag = MouseOrbit::Drag;
  MouseOrbit mouse;
  mouse.Move({0.5, 0.5});  // Before a drag begins nothing turns.
  EXPECT_EQ(mouse.orbit().azimuth_rad, 0);
  mouse.Begin(Drag::kTurn, {0.5, 0.5});
  mouse.Move({0.6, 0.55});
  EXPECT_NEAR(mouse.orbit().azimuth_rad, -0.1 * kPi, 1e-12);
  EXPECT_NEAR(mouse.orbit().elevation_rad, 0.05 * kPi, 1e-12);
  mouse.End();
  mouse.Move({0.9, 0.9});
  EXPECT_NEAR(mouse.orbit().azimuth_rad, -0.1 * kPi, 1e-12);
  mouse.Begin(Drag::kShift, {0.5, 0.5});
  mouse.Move({0.4, 0.8});
  EXPECT_NEAR((mouse.orbit().shift - Eigen::Vector2d(-0.1, 0.3)).norm(), 0, 1e-12);
  mouse.Move({-50, 0.8});
  EXPECT_GE(mouse.orbit().shift.x(), -2);
  mouse.Reset();
  EXPECT_EQ(mouse.orbit().shift.norm(), 0);
}

TEST(MouseOrbit, TheWheelGoesNearerAndBackWithinLimits) {
  MouseOrbit mouse;
  mouse.Scroll(3);
  EXPECT_LT(mouse.orbit().distance, 1);
  mouse.Scroll(-3);
  EXPECT_NEAR(mouse.orbit().distance, 1, 1e-12);
  mouse.Scroll(1000);
  EXPECT_GT(mouse.orbit().distance, 0.1);
  mouse.Scroll(-1000);
  EXPECT_LT(mouse.orbit().distance, 10);
}

}  // namespace
}  // namespace footing::scene
