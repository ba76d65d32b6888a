#pragma once

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

/// Two hands that swing together, seen without their period. Ours: eq. (4) needs a period, and has
/// none for up to two cycles while both hands change from one motion to another.
namespace footing::features {

/// Normalised cross-correlation at lag 0 of the newest `span_s` of both controllers, -1 to 1, with
/// the means removed and the right one turned by `from_right` (PairGrip): high when both move
/// alike, below zero when they alternate, whatever the period. 0: there are not so many samples, or
/// one stands still.
double CorrelationNow(const SampleGrid& left, const SampleGrid& right,
                      const Eigen::Matrix3d& from_right, double span_s);

/// For how long both have moved together.
struct Together {
  double lasted_s = 0;
  bool sure = false;  ///< That is long enough.
};

Together Next(const Together& before, const SampleGrid& left, const SampleGrid& right,
              const Eigen::Matrix3d& from_right, double elapsed_s, const PhaseConfig& config);

}  // namespace footing::features
