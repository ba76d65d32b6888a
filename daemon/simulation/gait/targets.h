#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

namespace footing::gait {

/// Length servo of one telescoping leg:
/// force = share * clamp(feed forward + kp (length - actual) + kd (rate - actual rate)).
struct AxialTarget {
  double length_m = 0;
  bool follow_rate = false;  ///< Rate from the change of length_m since the last step; else 0.
  double stiffness_n_per_m = 0;
  double damping_ns_per_m = 0;
  double feed_forward_n = 0;
  double min_n = -std::numeric_limits<double>::infinity();
  double share = 1;
};

enum class LegTask {
  kPlace,      ///< Hips and length bring the foot to r_HF_W.
  kPlaceHips,  ///< Hips aim the foot along r_HF_W, the length follows `axial`.
  kSupport,    ///< Hips carry the body's attitude, the length follows `axial`.
  kFree,       ///< Hips are damped only, the length follows `axial`.
};

struct LegTarget {
  LegTask task = LegTask::kFree;
  Eigen::Vector3d r_HF_W_m = Eigen::Vector3d::Zero();  ///< From the hip to where the foot is to be.
  AxialTarget axial;
  double hip_damping_nms_per_rad = 0;  ///< kFree.
};

/// What a state of a machine wants of the joints, before the servos.
struct Targets {
  std::array<LegTarget, 2> legs;
  bool hopping = false;  ///< Yaw servo of running and jumping.
  bool jumping = false;  ///< Both legs as one virtual leg; lean by speed.
  double lean_rad = 0;   ///< Desired pitch besides.
  Eigen::Vector3d rate_W_radps = Eigen::Vector3d::Zero();  ///< Desired of the body.
};

}  // namespace footing::gait
