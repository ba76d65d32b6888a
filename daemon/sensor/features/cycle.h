#pragma once

#include <Eigen/Core>

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// The direction of the horizontal part of a swing. Ours: it shows a twist of a limb that hangs,
/// which keeps its inclination.
struct SwingLine {
  bool valid = false;
  double angle_rad = 0;                             ///< From S's front, left positive.
  Eigen::Vector3d along = Eigen::Vector3d::Zero();  ///< The same as a unit vector in S,
  Eigen::Vector3d up = Eigen::Vector3d::Zero();     ///< and the vertical one.
};

/// Which end of a swing's line is its front, once known: a controller that was turned
/// within 60 degrees of the swing, and is turned further while it swings, keeps its front's end.
struct SwingEnd {
  bool known = false;
  double angle_rad = 0;  ///< Of the last line, from S's front, left positive.
};

/// The line's end that goes on from `before`; while none is known, or where it would be turned
/// further than hands are, the one nearer to the front.
SwingLine Continued(const SwingLine& line, const SwingEnd& before, const CycleConfig& config);
/// What is known after that line: a line that is not valid changes nothing.
SwingEnd Next(const SwingEnd& before, const SwingLine& line, const CycleConfig& config);

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
  SwingLine swing;
};

/// Which way, in (-pi/2, pi/2], the samples (m/s², one a row) swing across `mean_mps2`, which
/// points up. Not valid when they hardly do, or not along a line, or when S's left-right axis is
/// near the vertical.
SwingLine FindSwing(const Eigen::Matrix<double, Eigen::Dynamic, 3>& samples,
                    const Eigen::Vector3d& mean_mps2, const CycleConfig& config);

/// `period_s` > 0. Clipped samples are replaced by a fit of mean, fundamental and two harmonics
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

/// Mean of the filtered points over exactly `steps`, ending `late` grid points before the newest.
/// The grid must hold late + floor(steps) + 2 points.
Eigen::RowVector3d CycleMean(const SampleGrid& grid, int late, double steps);

}  // namespace footing::features
