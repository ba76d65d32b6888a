#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/base/result.h"

/// Quantiles of what a study reports: linear between the two nearest values, as in R (type 7) and
/// NumPy, so that a median is the mean of the two values in the middle. Those of common/text are
/// values that occurred.
namespace footing::statistics {

/// `share` is in [0, 1]. There must be one value.
inline double QuantileOf(std::vector<double> values, double share) {
  FOOTING_CHECK(!values.empty() && share >= 0 && share <= 1);
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

inline double MedianOf(std::vector<double> values) { return QuantileOf(std::move(values), 0.5); }

}  // namespace footing::statistics
