#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace footing::text {

/// The value of this rank, 0 the least; of the greatest rank if there are fewer. There must be one
/// value.
template <typename T>
T OfRank(std::vector<T> values, std::size_t rank) {
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The value below which this share of the values lies, one of them: rank floor(share * n), so that
/// Quantile(x, 1) is the greatest. 0 if there are none. `share` is in [0, 1].
inline double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  return OfRank(std::move(values), rank);
}

/// Of an even number of values, the greater of the two in the middle. 0 if there are none.
inline double Median(std::vector<double> values) { return Quantile(std::move(values), 0.5); }

}  // namespace footing::text
