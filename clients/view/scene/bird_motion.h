#pragma once

#include <array>

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

/// What moves for the eye alone, filtered over time: a copyable value.
struct BirdMotion {
  bool placed = false;
  double head_yaw_rad = 0;    ///< Filtered over 0.2 s, as a bird holds its head still.
  double head_pitch_rad = 0;  ///< Positive looks up.
  double head_lift_m = 0;     ///< Head above its place on the body, at most 0.10 m either way.
  double body_height_m = 0;
  std::array<double, 2> toe_spread{0, 0};  ///< 0 folded, 1 spread: 1 while the foot touches.
  double wing_spread = 0;                  ///< 1 while neither foot touches.
};

/// Moves on by dt_s >= 0.
BirdMotion Advance(const BirdMotion& motion, const BirdSkeleton& skeleton,
                   const CharacterPose& pose, double dt_s);

}  // namespace footing::scene
