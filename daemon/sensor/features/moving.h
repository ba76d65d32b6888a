#pragma once

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// Whether a controller moves (section 6, feature 1).
struct Moving {
  bool moving = false;
  /// Grid index of the first point that belongs to the motion, or of the first still one after it.
  std::int64_t since_index = 0;
  /// The period that the window is cut to, 0 while none was known since then. It follows a shorter
  /// one at once, a longer one only once that has lasted: a stop looks like a longer period at
  /// first.
  double period_s = 0;
  /// Grid index since which the period has been longer; 0 while it is not.
  std::int64_t longer_since_index = 0;
};

/// Standard deviation over the newest `count` filtered points: root of the sum of the three axes'
/// variances, m/s². 0 for fewer than two.
double Deviation(const SampleGrid& grid, int count);

/// The state after the newest point. `period_s` is the length of a cycle, 0 while unknown.
Moving Next(const Moving& before, const SampleGrid& grid, double period_s,
            const MovingConfig& config);

}  // namespace footing::features
