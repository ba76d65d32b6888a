#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/statistics/samples.h"
#include "common/statistics/steel.h"

namespace footing::statistics {

/// All values in one order, without the values: what rank statistics depend on.
struct RankedLabels {
  std::vector<std::size_t> group_sizes;  ///< The control's first.
  std::vector<std::size_t> class_sizes;  ///< Of equal values, in rising order.
  std::vector<std::size_t> labels;       ///< The group of each value, in rising order.
};
RankedLabels Rank(const Groups& groups);

/// Counts of one assignment of labels, while classes of equal values are added in rising order.
struct RankCounts {
  explicit RankCounts(std::size_t groups)
      : below(groups, 0), twice_u(groups, 0), tie_sums(groups, 0) {}

  /// `of_class` is how many of the class's values each group has.
  void Add(const std::vector<std::int64_t>& of_class);
  /// Undoes Add of the same counts.
  void Remove(const std::vector<std::int64_t>& of_class);

  std::vector<std::int64_t> below;    ///< Values of each group so far.
  std::vector<std::int64_t> twice_u;  ///< 2 U_i; the control's stays 0.
  std::vector<double> tie_sums;       ///< Sum of t^3 - t over the classes of the pair.
};

/// Turns counts into scores.
class SteelScale {
 public:
  SteelScale(const RankedLabels& ranked, Ties ties);
  /// Of group `i` >= 1.
  RankScore Score(std::size_t i, const RankCounts& counts) const;
  /// E[psi(1, 2) psi(1, 3)] over random values 1, 2, 3 of all, with psi = -1/2, 0, 1/2 as the first
  /// is greater, equal or smaller: 1/12 without ties.
  double shared_covariance() const { return shared_covariance_; }
  double JointVariance(std::size_t i) const;

 private:
  std::vector<double> sizes_;
  Ties ties_;
  double pair_variance_ = 0;      ///< E[psi(1, 2)^2].
  double shared_covariance_ = 0;  ///< See shared_covariance().
};

RankCounts CountLabels(const RankedLabels& ranked, const std::vector<std::size_t>& labels);

/// Runs through all ways to deal the classes to groups of these sizes, with the probability of each
/// where every assignment of labels is equally likely. False when there are more than `most`.
bool RunThroughTables(
    const RankedLabels& ranked, std::size_t most,
    const std::function<void(const RankCounts& counts, double probability)>& take);

}  // namespace footing::statistics
