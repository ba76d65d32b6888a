#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/pose_run/felt_forces.h"
#include "daemon/offline/pose_run/pose_run.h"

/// Measured force plates in place of inverse dynamics.
namespace footing::pose_run {

/// What became of a trial's plates.
struct PlateReport {
  std::vector<PlateUse> plates;
  double begin_s = 0, end_s = 0;  ///< The stretch that is performed, on the motion's clock.
  /// Of the time that motion and forces have in common: where the plates carry what the motion
  /// needs, within a quarter of the weight.
  double supported_share = 1;
  double begin_mps = 0;    ///< Of the centre of mass where the stretch begins.
  double mass_kg = 0;      ///< Of the plates: their mean over the stretch.
  double force_rms_n = 0;  ///< Vertical: measured less inverse dynamics.
  /// The same, of a body as heavy as the measured forces have it in their mean.
  double force_own_mass_rms_n = 0;
  Eigen::Vector2d cop_rms_m;   ///< Of both feet together, the same: along x and y.
  Eigen::Vector2d cop_bias_m;  ///< The mean of that.
  std::vector<std::string> warnings;
};

/// The same frames with the boards driven by the plates, and by inverse dynamics. Both are
/// evaluated from judged_from on.
struct PlateRun {
  PoseRun measured, simulated;
  PlateReport report;
  /// COM by the plates' own force (ComByForce), m, a column a frame of `measured` from judged_from
  /// on. Empty for a trial that is too short for it, or starts or ends in motion.
  Eigen::Matrix3Xd com_by_force_m = {};
};

/// As RunPose, with measured forces. The longest stretch in which the plates carry the body is
/// performed; in front of it stands the T-pose of Stage, with simulated forces, whose share of each
/// foot and COP go over into the first measured ones while the T-pose is left. UsageError for a
/// loop. InvalidData when motion and forces have less than half a second in common, when no such
/// stretch is that long, and when the COP is nowhere near the feet.
Result<PlateRun> RunOnPlates(const motion::Motion& clip, const motion::GroundForces& forces,
                             const Settings& settings, const std::string& origin,
                             const std::string& forces_origin);

}  // namespace footing::pose_run
