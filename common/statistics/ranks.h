#pragma once

#include <vector>

namespace footing::statistics {

/// Ranks from 1; tied values share the mean of theirs.
struct MeanRanks {
  std::vector<double> ranks;  ///< In the order of the values.
  double tie_sum = 0;         ///< Of t^3 - t over the groups of t tied values.
};

/// Values above the least one of a group by at most this share of it are tied; 0: equal ones, and
/// values may be negative.
MeanRanks RankWithTies(const std::vector<double>& values, double tied_share = 0);

}  // namespace footing::statistics
