#pragma once

#include <array>

#include <Eigen/Geometry>

#include "clients/view/scene/camera.h"
#include "clients/view/scene/update.h"

namespace footing::scene {

/// The names of the bird's links and contact points, resolved once a skeleton.
struct BirdSkeleton {
  int body = 0;
  std::array<int, 2> hips{1, 3};  ///< Left, right.
  std::array<int, 2> feet{0, 1};  ///< Contact points: left, right.
};

/// Finds the parts by name; those missing keep the usual order.
BirdSkeleton FindParts(const stream::Skeleton& skeleton);

/// A foot as it is drawn: it stays where it touched for as long as it touches. The one of the
/// simulation is a ball on the end of the leg, and creeps by some millimetres in a stance.
struct DrawnFoot {
  bool touches = false;
  Eigen::Vector3d planted_m = Eigen::Vector3d::Zero();  ///< W.
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();    ///< From the simulation's, level, W.
};

/// Cosmetic motion of the bird over the poses of the simulation: a copyable value.
///
/// While it walks the head rests in space and is then thrust ahead, once a step, as pigeons' heads
/// do (Frost 1978, "The optokinetic basis of head-bobbing in the pigeon"); while it runs it stays
/// over the body. The tail lags behind the body's motion, the wings open in flight and for balance,
/// the eyes look at the next foothold, and blink at every eighth step. Nothing depends on poses of
/// some seconds ago, so a picture of a recording is the same whatever was shown before it.
struct BirdMotion {
  bool placed = false;
  double head_yaw_rad = 0;    ///< Filtered over 0.2 s, as a bird holds its head still.
  double head_pitch_rad = 0;  ///< Positive looks up.
  double head_lift_m = 0;     ///< Head above its place on the body, at most 0.10 m either way.
  double body_height_m = 0;
  Spring head_ahead;            ///< Head before its place on the body, m, by bobbing.
  bool head_rests = false;      ///< In space; otherwise it is thrust ahead.
  Spring tail_pitch, tail_yaw;  ///< The tail's, against the body, rad; up and left are positive.
  std::array<double, 2> toe_spread{0, 0};       ///< 0 folded, 1 spread: 1 while the foot touches.
  double wing_spread = 0;                       ///< 1 while neither foot touches; less for balance.
  double lid = 0;                               ///< 0 open, 1 closed.
  double gaze_yaw_rad = 0, gaze_pitch_rad = 0;  ///< The eyes', in the head; left, up.

  /// The last pose.
  Eigen::Vector3d body_m = Eigen::Vector3d::Zero(), velocity_mps = Eigen::Vector3d::Zero();
  double body_yaw_rad = 0;
  std::array<DrawnFoot, 2> feet;  ///< Left, right.
  double blink_s = 1;             ///< Since the last blink began.
};

/// Moves on by dt_s >= 0. A body that is somewhere else at once starts again there.
BirdMotion Advance(const BirdMotion& motion, const BirdSkeleton& skeleton,
                   const CharacterPose& pose, double dt_s);

}  // namespace footing::scene
