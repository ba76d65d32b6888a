#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/base/result.h"

/// Tests of several treatments against one control: what a study of interfaces asks.
namespace footing::statistics {

/// Alternative hypothesis: values of a treatment are different, greater or smaller.
enum class Alternative { kTwoSided, kGreater, kLess };

/// Where p comes from: every relabelling, random ones, or the limit distribution.
enum class Method { kExact, kPermutation, kAsymptotic };

/// Values under one condition.
struct Group {
  std::string name;
  std::vector<double> values;  ///< Finite, in any order.
};

/// The control, then at least one treatment; independent samples.
using Groups = std::vector<Group>;

/// One value for each subject in each group: a within-subject design.
struct Blocks {
  std::vector<std::string> groups;          ///< The control first.
  std::vector<std::string> subjects;        ///< One for each row of `values`.
  std::vector<std::vector<double>> values;  ///< Values of a subject, in the order of `groups`.
};

/// An end without a bound is infinite.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// How strongly a statistic, 0 where nothing differs, speaks for the alternative.
inline double Evidence(double statistic, Alternative alternative) {
  switch (alternative) {
    case Alternative::kTwoSided:
      return std::abs(statistic);
    case Alternative::kGreater:
      return statistic;
    case Alternative::kLess:
      return -statistic;
  }
  return 0;
}

/// With the end that the alternative leaves open at that of `widest`.
inline Interval Directed(Interval interval, Alternative alternative, const Interval& widest = {}) {
  if (alternative == Alternative::kGreater) interval.high = widest.high;
  if (alternative == Alternative::kLess) interval.low = widest.low;
  return interval;
}

/// Tests by relabelling: where nothing differs, every assignment of labels to values is as likely
/// as the observed one.
struct Relabelling {
  /// Without: exact where `most_tables` allow it, otherwise random.
  std::optional<Method> method;
  std::uint64_t seed = 1;
  std::size_t permutations = 100'000;   ///< Random ones.
  std::size_t most_tables = 4'000'000;  ///< That an exact test runs through.
};

/// Result of one comparison.
struct RelabelledRow {
  double p = 1;  ///< Adjusted: share of relabellings whose greatest evidence reaches this one's.
  double standard_error = 0;  ///< Standard error of p by random relabelling; 0 if exact.
  double smallest_p = 0;      ///< The least that p can be with these values; 0 if unknown.
};

/// Result of a relabelling test, a row a comparison.
struct Relabelled {
  Method method = Method::kExact;
  double relabellings = 0;  ///< Distinct tables run through, or random draws.
  std::vector<RelabelledRow> rows;
};

/// Takes the evidence of each comparison under one relabelling, and its probability.
using TakeEvidence = std::function<void(const std::vector<double>& evidence, double probability)>;
/// Runs through all relabellings, unless there are more than `most`: then false.
using RunThroughAll = std::function<bool(std::size_t most, const TakeEvidence& take)>;
/// The evidence under a random relabelling; it lasts until the next one.
using DrawEvidence = std::function<const std::vector<double>&(std::mt19937_64& engine)>;

/// Single-step adjusted p of each comparison. Evidence counts as reached within `tolerance`.
Result<Relabelled> CompareWithRelabellings(const std::vector<double>& observed, double tolerance,
                                           const Relabelling& relabelling,
                                           const RunThroughAll& run_through_all,
                                           const DrawEvidence& draw);

/// A whole number in [0, count), evenly, the same bits everywhere.
std::size_t DrawBelow(std::mt19937_64& engine, std::size_t count);

/// Random order, each as likely.
template <typename Value>
void Shuffle(std::vector<Value>& values, std::mt19937_64& engine) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[DrawBelow(engine, i)]);
  }
}

/// Which ties the deviation of a rank statistic allows for: those of the two groups compared
/// (Steel's own), or those of all groups together, which are fixed under relabelling.
enum class Ties { kPairwise, kJoint };

/// One treatment against the control.
///
///   | symbol | name here | meaning                                                        |
///   | U_i    | u         | pairs with the treatment's value greater; a tie counts half    |
///   |        | mean      | n_0 n_i / 2, what U_i is on average where nothing differs      |
///   |        | deviation | standard deviation of U_i where nothing differs, given the ties |
///   | z_i    | z         | (u - mean) / deviation; 0 where all values are equal           |
struct RankScore {
  double u = 0;
  double mean = 0;
  double deviation = 0;
  double z = 0;
};

/// Steel's score of each treatment against the control.
std::vector<RankScore> SteelScores(const Groups& groups, Ties ties);

/// The limit distribution of max z_i: z_i become normal, with correlations l_i l_j.
struct SteelLimit {
  Ties ties = Ties::kPairwise;
  /// With pairwise ties: l_i^2 = n_i / (n_i + n_0 + 1), exact for finite groups without ties, in
  /// place of n_i / (n_i + n_0), which the printed tables use. Joint ties have the exact value.
  bool finite_sample = false;
  bool continuity = false;  ///< U_i is moved half a pair towards its mean.
};

/// Adjusted p of every treatment by the limit distribution.
std::vector<double> SteelAsymptotic(const Groups& groups, Alternative alternative,
                                    const SteelLimit& limit);

/// Adjusted p of every treatment by relabelling all values: the share of relabellings with
/// max z_j >= z_i. Exact enumeration (UsageError if there are too many tables), or random ones.
Result<Relabelled> SteelRelabelling(const Groups& groups, Alternative alternative, Ties ties,
                                    const Relabelling& relabelling);

/// All values in one order, without the values: what rank statistics depend on.
struct RankedLabels {
  std::vector<std::size_t> group_sizes;  ///< The control's first.
  std::vector<std::size_t> class_sizes;  ///< Numbers of equal values, in rising order.
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
  /// Score of group `i` >= 1.
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

/// Counts of each treatment for these labels, in the order of `ranked`.
RankCounts CountLabels(const RankedLabels& ranked, const std::vector<std::size_t>& labels);

/// Runs through all ways to deal the classes to groups of these sizes, with the probability of each
/// where every assignment of labels is equally likely. False when there are more than `most`.
bool RunThroughTables(
    const RankedLabels& ranked, std::size_t most,
    const std::function<void(const RankCounts& counts, double probability)>& take);

}  // namespace footing::statistics
