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
  double angle_rad = 0;  ///< Angle of the last line, from S's front, left positive.
};

/// The line's end that goes on from `before`; while none is known, or where it would be turned
/// further than hands are, the one nearer to the front.
SwingLine Continued(const SwingLine& line, const SwingEnd& before, const CycleConfig& config);
/// State after that line: a line that is not valid changes nothing.
SwingEnd Next(const SwingEnd& before, const SwingLine& line, const CycleConfig& config);

/// Measures of the newest whole cycle of raw samples (section 6, features 4 and 5).
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

/// Inclination of a controller from the direction of gravity.
struct Inclination {
  double roll_rad = 0;   ///< asin(ax / g): left side higher is positive.
  double pitch_rad = 0;  ///< asin(ay / g): front higher is positive.
  /// Rotation about the front by the direction of (ax, -az): a force towards the joint of a limb
  /// that swings makes the mean larger than g, which shifts the others but not this. 0 where the
  /// front is near the vertical.
  bool axial_valid = false;
  double axial_rad = 0;
};

/// From gravity as the sensor sees it; always finite.
Inclination InclinationOf(const Eigen::Vector3d& gravity_mps2);

/// Weights of the newest points for an integral over exactly `steps` grid steps that ends at the
/// newest: the trapezoidal rule with a cut last interval. They add up to `steps`; oldest first.
Eigen::ArrayXd CycleWeights(double steps);

/// Mean of the filtered points over exactly `steps`, ending `late` grid points before the newest.
/// The grid must hold late + floor(steps) + 2 points.
Eigen::RowVector3d CycleMean(const SampleGrid& grid, int late, double steps);

/// Where the parabola through three equally spaced values has its minimum, in steps from the
/// middle.
double ParabolaMinimum(double before, double middle, double after);

/// Equations (3) and (4) as printed: the sum of W(t) one(t) . other(t - lag) over the rows of
/// `one`, which are tp, for each lag from 0. Both end at T; `other` is longer by the largest lag.
Eigen::ArrayXd PrintedCorrelation(const Eigen::Matrix<double, Eigen::Dynamic, 3>& one,
                                  const Eigen::Matrix<double, Eigen::Dynamic, 3>& other);

/// Phase by cross-correlation (section 6, eq. 4).
///
/// | paper | here | unit |
/// |---|---|---|
/// | aL(t), aR(t) | SampleGrid::Filtered of the left and the right controller | m/s² |
/// | mean aL, mean aR | mean over the newest cycle | m/s² |
/// | tau | phase / (2 pi f) | s |
/// | Rc(tau) | Correlation, normalised to at most 1 | 1 |
///
/// Departures (docs/features.md): tp is exactly one cycle and W = 1 in it, and aR(t - tau) is
/// continued periodically, so that the newest cycle alone decides; Rc is summed over its first
/// harmonics.
struct PhaseEstimate {
  bool found = false;
  double phase_rad = 0;    ///< Right minus left in (-pi, pi]: positive, the right one leads.
  double correlation = 0;  ///< At the peak; 1 when the hands swing alike.
};

/// `period_s` > 0 is common to both. Not found: no whole common cycle, one stands still, or the two
/// do not swing alike. `from_right` turns the right one as the left one lies in its hand
/// (PairGrip). Controllers that swing alike but are turned against each other otherwise are
/// compared in the axes of their swings, whose ends must be known or within 60 degrees of the
/// fronts.
PhaseEstimate FindPhase(const SampleGrid& left, const SampleGrid& right, double period_s,
                        const Eigen::Matrix3d& from_right, const SwingEnd& left_end,
                        const SwingEnd& right_end, const PhaseConfig& config,
                        const CycleConfig& cycle);

/// Equation (4) as printed: the lag of the peak of Rc within tp, which is one cycle. Sensors are
/// compared in their own axes, and no correlation is given. Not found: there are no two common
/// cycles yet.
PhaseEstimate PhaseAsPrinted(const SampleGrid& left, const SampleGrid& right, double period_s);

/// The phase that is published: jumps must persist, a loss is bridged for a while.
struct Phase {
  bool valid = false;
  double phase_rad = 0;
  double lost_s = 0;           ///< How long nothing was found.
  bool jumping = false;        ///< A jump is seen that has not persisted yet;
  double candidate_rad = 0;    ///< it leads here,
  double candidate_age_s = 0;  ///< and has been seen for this time.
};

/// The phase after a new estimate, `elapsed_s` after the one before.
Phase Next(const Phase& before, const PhaseEstimate& estimate, double period_s, double elapsed_s,
           const PhaseConfig& config);

}  // namespace footing::features
