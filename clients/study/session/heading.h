#pragma once

#include <cstddef>

namespace footing::study {

/// How much the character's heading swings: the standard deviation of its heading error against the
/// track's centre line, rad. The gait paper (section 8.1) compares the "oscillation of the
/// character's orientation" without defining it.
class HeadingOscillation {
 public:
  void Add(double heading_error_rad);
  /// Whether the character stands on its feet: from a failure to the put-back frames are left out.
  void SetUpright(bool upright) { upright_ = upright; }
  /// NaN before the second value.
  double StandardDeviation() const;

 private:
  bool upright_ = true;
  std::size_t count_ = 0;
  double mean_ = 0;
  double squares_ = 0;  ///< Sum of squared deviations from the mean (Welford).
};

}  // namespace footing::study
