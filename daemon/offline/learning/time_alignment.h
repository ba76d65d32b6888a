#pragma once

#include "common/base/result.h"
#include "daemon/offline/learning/force_trace.h"

namespace footing::learning {

/// How the clock of a recording goes beside that of a motion: recording = offset_s + (1 + drift)
/// motion, both counted from the first columns of their traces.
struct TimeAlignment {
  double offset_s = 0;
  double drift = 0;        ///< Positive: the recording's clock is the faster one.
  double residual_s = 0;   ///< Root mean square of what is left, between pieces of eight seconds,
  int pieces = 0;          ///< of which there are so many; one or two say nothing of it.
  double correlation = 0;  ///< Of the vertical forces, where both are.
  double overlap_s = 0;
  int stomps_recording = 0, stomps_motion = 0;
  int stomps_both = 0;  ///< Found in both, within 50 ms of each other.

  double ToRecording(double motion_s) const { return offset_s + (1 + drift) * motion_s; }
  double ToMotion(double recording_s) const { return (recording_s - offset_s) / (1 + drift); }
};

/// Stomps vote for the offset: where three and more of one have the intervals of the other's, the
/// forces are correlated over all that both have, and the best is kept. Then pieces of eight
/// seconds are moved until each correlates best, and a line through their lags is the offset and
/// the drift. Clocks are quartz: the drift is held to 0 with kDriftSd, which only matters where a
/// recording is too short to estimate.
///
/// InvalidData: fewer than three stomps in one of them, none that go together, or forces that do
/// not (a correlation under kLeastCorrelation).
Result<TimeAlignment> AlignInTime(const ForceTrace& recorded, const ForceTrace& moved);

inline constexpr double kDriftSd = 100e-6;
inline constexpr double kLeastCorrelation = 0.7;  ///< Plates under drop jumps have 0.94.
inline constexpr int kFewestStomps = 3;

}  // namespace footing::learning
