#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "daemon/simulation/momentum/contact_loads.h"

namespace footing::momentum {

/// A foot's size and direction, from the subject file or taken in the T-pose.
struct FootShape {
  double length_m = 0.26;
  double width_m = 0.10;
  double yaw_rad = 0;  ///< Angle of the toes from W's x axis, to the left positive.
  /// Where the centre of pressure of a standing body is, from the heel as a share of the length.
  double rest_share = 0.42;
};

/// Who stands on the cells.
struct Subject {
  double com_height_m = 1.0;  ///< Height of the centre of mass over the ground, in the T-pose.
  /// How much lower it is when the body stands upright with its arms hanging: what the heights'
  /// anchor means by upright. 0 where the calibration was made so instead of in a T-pose.
  double arms_hang_m = 0.028;
  std::array<FootShape, kFeet> feet{};
};

/// Where one foot is. The reference point F is where the centre of pressure is at rest.
struct FootEstimate {
  bool contact = false;
  bool valid = false;  ///< False until its place has been seen.
  double load_n = 0;
  bool cop_valid = false;
  Eigen::Vector3d p_WP_m = Eigen::Vector3d::Zero();  ///< Centre of pressure; 0 while not valid.
  Eigen::Vector3d p_WF_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d variance_m2 = Eigen::Vector3d::Zero();  ///< Variance of p_WF, W.
  double airborne_s = 0;                                  ///< Since the foot left the cells.
  double at_edge_s = 0;  ///< Since its COP came to the edge of the cells: it may be further out.
};

/// One frame of either mode. Everything is finite at all times; `valid` says whether it means
/// something. Positions are as they were `lag_s` before `time_s`, velocity, acceleration, momentum
/// and feet as they are at `time_s`.
struct Estimate {
  double time_s = 0;
  double lag_s = 0;
  bool valid = false;
  /// False while the height is not known to 12 cm, or the loads are not the whole weight.
  bool trusted = true;
  /// False while the cells carry less or more than a body that neither falls nor rises for seconds:
  /// it stands on something else, too, or carries a load (LoadShare).
  bool whole_weight = true;
  /// A foot has just stepped ahead or back (StepWatch): the horizontal position lags behind by more
  /// than filters of bodies in place know, and its variance says so. Best mode.
  bool stepped = false;
  double load_share = 1;  ///< Mean load of the last seconds over the T-pose's weight.
  Eigen::Vector3d p_WC_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_WC_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d position_variance_m2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_variance_m2ps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum_kgm2ps = Eigen::Vector3d::Zero();  ///< About C.
  Eigen::Vector3d angular_momentum_rate_nm = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_momentum_variance = Eigen::Vector3d::Zero();
  std::array<FootEstimate, kFeet> feet{};
  std::uint32_t resets = 0;  ///< How often the filters were reset.
};

}  // namespace footing::momentum
