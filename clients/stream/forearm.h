#pragma once

#include <Eigen/Core>

#include "clients/stream/body_stage.h"

namespace footing::stream_client {

/// What a device on a forearm feels, a column a frame of the stage's motion, in its frame S: with
/// hanging arms x is left, y front, z down.
struct ForearmCourse {
  Eigen::Matrix3Xd specific_force_S_mps2;
  Eigen::Matrix3Xd angular_velocity_S_radps;

  /// Between two frames.
  Eigen::Vector3d ForceAt(const Stage& stage, double t_s) const;
  Eigen::Vector3d TurnAt(const Stage& stage, double t_s) const;
};

/// Of side 0 (left) or 1: two thirds of the way from the elbow to the wrist. Poses are smoothed at
/// 10 Hz first, since recorded ones are not fit to be differentiated twice.
ForearmCourse FollowForearm(const Stage& stage, int side);

}  // namespace footing::stream_client
