#pragma once

#include <cstddef>

namespace footing::study {

/// How much the character's heading swings: the standard deviation of its heading error against the
/// track's centre line, rad. The gait paper (section 8.1) compares the "oscillation of the
/// character's orientation" without defining it.
class HeadingOscillation {
 public:
  void Add(double heading_error_rad);
  /// NaN before the second value.
  double StandardDeviation() const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;  ///< Sum of squared deviations from the mean (Welford).
};

}  // namespace footing::study
