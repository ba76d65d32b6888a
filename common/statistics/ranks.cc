#include "common/statistics/ranks.h"

#include <algorithm>
#include <cstddef>

namespace footing::statistics {

MeanRanks RankWithTies(const std::vector<double>& values, double tied_share) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  MeanRanks result;
  result.ranks.resize(values.size());
  std::size_t first = 0;
  while (first < order.size()) {
    const double most = values[order[first]] * (1 + tied_share);
    std::size_t end = first + 1;
    while (end < order.size() && values[order[end]] <= most) ++end;
    // Ranks first + 1 to end.
    const double rank = static_cast<double>(first + 1 + end) / 2;
    for (std::size_t i = first; i < end; ++i) result.ranks[order[i]] = rank;
    const double t = static_cast<double>(end - first);
    result.tie_sum += t * t * t - t;
    first = end;
  }
  return result;
}

}  // namespace footing::statistics
