#pragma once

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/sample_grid.h"

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
namespace footing::features {

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

/// The phase that is published: jumps must persist, a loss is bridged for a while.
struct Phase {
  bool valid = false;
  double phase_rad = 0;
  double lost_s = 0;           ///< How long nothing was found.
  bool jumping = false;        ///< A jump is seen that has not persisted yet;
  double candidate_rad = 0;    ///< it leads here,
  double candidate_age_s = 0;  ///< and has been seen for this time.
};

Phase Next(const Phase& before, const PhaseEstimate& estimate, double period_s, double elapsed_s,
           const PhaseConfig& config);

}  // namespace footing::features
