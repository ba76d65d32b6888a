#pragma once

#include <Eigen/Core>

namespace footing::users {

/// Where a worn sensor is, and its axes x left, y front, z down in W.
struct SensorPose {
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WS = Eigen::Matrix3d::Identity();
};

/// The sensor's axes from two of them: where its left and its front point.
Eigen::Matrix3d AxesFrom(const Eigen::Vector3d& left, const Eigen::Vector3d& front);

/// A remote held in front of a bent elbow that is swung up and down from the wrist, whose
/// joint is the origin. Angles: `swing_rad` up, `roll_rad` left side up.
SensorPose WristPose(double swing_rad, double roll_rad);

/// A remote held along the forearm, front to the fingers, buttons up when the elbow is bent: the
/// upper arm is `shoulder_rad` before hanging, the elbow bent by `elbow_rad`, the forearm and what
/// it holds turned about itself by `turned_rad`, to the right; `aside_rad` is the direction of the
/// swing, left of forward.
SensorPose ArmPose(double height_m, double shoulder_rad, double elbow_rad, double turned_rad,
                   double aside_rad);

/// A remote on a shin, axes of the frame M (z down along the shin): the thigh is `hip_rad` before
/// hanging, the knee bent by `knee_rad`; `pelvis_m` is the rise of the pelvis, `grip_rad` a
/// rotation about the shin.
SensorPose ShinPose(double height_m, double hip_rad, double knee_rad, double pelvis_m,
                    double grip_rad);

/// A remote on the head, inclined by `roll_rad` about the neck, left side up.
SensorPose HeadPose(double height_m, double roll_rad, double pelvis_m);

/// The same on the chest of a trunk that inclines at the hips; axes of the frame M.
SensorPose TrunkPose(double height_m, double roll_rad, double pelvis_m);

/// Specific force in S from three poses `step_s` apart, of the middle one: acceleration and
/// gravity.
Eigen::Vector3d SpecificForce(const SensorPose& before, const SensorPose& at,
                              const SensorPose& after, double step_s);

}  // namespace footing::users
