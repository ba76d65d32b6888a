#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/virtual/devices/scene.h"
#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "daemon/offline/pose_run/pose_run.h"

namespace footing::pose_run {

/// Which foot stood on one plate, and how surely.
struct PlateUse {
  std::string plate;
  std::array<double, virtual_sensors::kFeet> loaded_s{};  ///< By foot.
  double beside_m = 0;  ///< Mean distance of the COP from the line heel to ball of that foot.
};

/// Forces of the plates under each foot, at the forces' rate from the clip's first frame on, in W
/// of the scene. A sample of a plate under 20 N counts as nothing: its COP means nothing.
struct FeltForces {
  double rate_hz = 0;
  std::array<Eigen::VectorXd, virtual_sensors::kFeet> load_n;
  std::array<Eigen::Matrix2Xd, virtual_sensors::kFeet> moment_nm;  ///< Load times COP.
  Eigen::Matrix2Xd shear_n;  ///< On the person, of all plates together.
  std::vector<PlateUse> plates;

  /// Mean over `span_s` around a time of the clip; the COP is NaN where there is no load.
  virtual_sensors::FootForce Mean(std::size_t foot, double time_s, double span_s) const;
  Eigen::Vector2d MeanShear(double time_s, double span_s) const;
};

/// Gives every contact of a plate (a run of more than 20 N) to the foot that its COP is nearer to,
/// in the mean of the run weighted by load. `scene` is Stage of `clip`, behind its T-pose.
FeltForces FeelPlates(const motion::Motion& clip, const virtual_sensors::Scene& scene,
                      const motion::GroundForces& forces);

// Measured force plates in place of inverse dynamics.

/// Use of a trial's plates and their agreement with the motion.
struct PlateReport {
  std::vector<PlateUse> plates;
  double begin_s = 0, end_s = 0;  ///< The stretch that is performed, on the motion's clock.
  /// Share of the time that motion and forces have in common: where the plates carry what the
  /// motion needs, within a quarter of the weight.
  double supported_share = 1;
  double begin_mps = 0;    ///< Speed of the centre of mass where the stretch begins.
  double mass_kg = 0;      ///< Mass by the plates: their mean over the stretch.
  double force_rms_n = 0;  ///< Vertical: measured less inverse dynamics.
  /// The same, of a body as heavy as the measured forces have it in their mean.
  double force_own_mass_rms_n = 0;
  Eigen::Vector2d cop_rms_m;   ///< COP of both feet together, the same: along x and y.
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

/// COM by the plates' own force (ComByForce), W, m, a column a frame of `run` from judged_from on.
/// `begin_s`: where in the run the clip begins, which `felt` is timed by. Empty for a trial of less
/// than five seconds, and for one that begins or ends with the COM faster than 0.3 m/s.
Eigen::Matrix3Xd ComByPlates(const PoseRun& run, const FeltForces& felt, double begin_s);

// The centre of mass by the forces of plates alone, without masses of segments.

/// Forces of all plates together, a column a frame, W.
struct ForceCourse {
  double rate_hz = 0;
  Eigen::Matrix3Xd force_n;  ///< On the person, with the shear.
  Eigen::Matrix2Xd cop_m;    ///< Counts by the load on it; finite where there is one.
};

/// Path of the COM, m, a column a frame: the force integrated twice. Constants of the integration
/// are fitted over the whole course by least squares. Upwards they are height, velocity and mass,
/// fitted to `height_m`, a path of the COM's height by other means. Level they are place, velocity
/// and a constant force, so that the angular momentum which the COP implies about the COM changes
/// by nothing in the mean: COP = c - z / (g + z'') c'' (Zatsiorsky & King 1998 fix the constants
/// where c'' is 0). A body in place needs to turn to and fro in the course: five seconds of squats
/// will do, a single jump will not.
Eigen::Matrix3Xd ComByForce(const ForceCourse& course, const Eigen::VectorXd& height_m);

}  // namespace footing::pose_run
