#pragma once

#include <Eigen/Core>

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// What the newest whole cycle of raw samples says (section 6, features 4 and 5).
struct Cycle {
  bool valid = false;  ///< There is a whole cycle.
  /// Too much of it is clipped to fill it in: the amplitude is a lower bound, there is no mean.
  bool clipped = false;
  /// Half peak to peak along the dominant axis of the cycle's motion, m/s². Raw samples: the filter
  /// would smooth the spikes of rapid motion.
  double amplitude_mps2 = 0;
  /// Mean over exactly one cycle in S: gravity, as long as the motion is cyclic and not too fast.
  Eigen::Vector3d mean_mps2 = Eigen::Vector3d::Zero();
};

/// `period_s` > 0. Clipped samples are replaced by a fit of mean, fundamental and second harmonic
/// to the others, never nearer to zero than the end of the range.
Cycle NewestCycle(const SampleGrid& grid, double period_s, const CycleConfig& config);

struct Inclination {
  double roll_rad = 0;   ///< asin(ax / g): left side higher is positive.
  double pitch_rad = 0;  ///< asin(ay / g): front higher is positive.
};

/// From gravity as the sensor sees it; always finite.
Inclination InclinationOf(const Eigen::Vector3d& gravity_mps2);

/// Weights of the newest points for an integral over exactly `steps` grid steps that ends at the
/// newest: the trapezoidal rule with a cut last interval. They add up to `steps`; oldest first.
Eigen::ArrayXd CycleWeights(double steps);

}  // namespace footing::features
