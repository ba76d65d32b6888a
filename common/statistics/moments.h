#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace footing::statistics {

/// Exact where all values are equal. There must be one value.
inline double Mean(const std::vector<double>& values) {
  const double first = values.front();
  double sum = 0;
  for (const double value : values) sum += value - first;
  return first + sum / static_cast<double>(values.size());
}

/// The root of the sum of squares, without overflow or underflow on the way.
inline double Norm(const std::vector<double>& values) {
  double greatest = 0;
  for (const double value : values) greatest = std::max(greatest, std::abs(value));
  if (greatest == 0) return 0;
  double sum = 0;
  for (const double value : values) sum += (value / greatest) * (value / greatest);
  return greatest * std::sqrt(sum);
}

}  // namespace footing::statistics
