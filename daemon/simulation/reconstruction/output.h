#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "daemon/simulation/momentum/estimate.h"

namespace footing::reconstruction {

/// One frame. All of it is finite at all times; `valid` says whether the pose means something.
struct Output {
  double time_s = 0;  ///< Of the inputs; the pose is of `lag_s` before.
  bool calibrated = false;
  double calibration_progress = 0;  ///< 0 to 1.
  std::uint32_t calibration_restarts = 0;
  bool valid = false;
  double lag_s = 0;
  std::uint32_t resets = 0;
  double mass_kg = 0;
  momentum::Estimate momentum;  ///< By the loads, and by the posture of hands and feet.
  /// COM: in best mode its height is that of the pose, which hands and feet have a part in; the
  /// rest is the loads'.
  Eigen::Vector3d com_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_variance_m2 = Eigen::Vector3d::Zero();
  /// COM by hands and feet alone; in best mode, while both hands are there.
  std::optional<Eigen::Vector3d> posture_com_W_m;
  /// How badly what is measured and what is known of people fit together, in best mode: square of
  /// what is left of the terms, by their deviations, a row, in the mean of the last half second. 1
  /// where all deviations are right. With more than 1.5 the pose's deviations grow, with more than
  /// 2 it is not valid: the person does what nothing here knows, such as walking on boards.
  double misfit = 0;
  Eigen::VectorXd q;  ///< Pose of the body's skeleton; a T-pose until calibrated.
  std::vector<Eigen::Matrix3d> R_WJ;
  std::vector<Eigen::Vector3d> p_WJ_m;
  std::vector<double> joint_sd_m;  ///< Of each joint's position, along one axis.
};

}  // namespace footing::reconstruction
