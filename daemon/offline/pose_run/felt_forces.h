#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "common/virtual/motion/motion.h"
#include "common/virtual/motion/table.h"
#include "common/virtual/devices/scene.h"

namespace footing::pose_run {

/// Which foot stood on one plate, and how surely.
struct PlateUse {
  std::string plate;
  std::array<double, virtual_sensors::kFeet> loaded_s{};  ///< By foot.
  double beside_m = 0;  ///< Mean distance of the COP from the line heel to ball of that foot.
};

/// What the plates felt under each foot, at the forces' rate from the clip's first frame on, in W
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

}  // namespace footing::pose_run
