#include "common/statistics/within_subject.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include "common/base/result.h"

namespace footing::statistics {
namespace {

using Rows = std::vector<std::vector<double>>;
/// The evidence in the sums of the columns.
using EvidenceOfSums =
    std::function<void(const std::vector<double>& sums, std::vector<double>& evidence)>;

/// The distinct orders of each row, each as likely as the others of its row.
class RowOrders {
 public:
  explicit RowOrders(const Rows& rows) : rows_(rows), sums_(rows.front().size(), 0.0) {
    for (std::vector<double>& row : rows_) std::sort(row.begin(), row.end());
  }

  /// False when there are more than `most`.
  bool RunThrough(std::size_t most, const EvidenceOfSums& evidence_of, const TakeEvidence& take) {
    double count = 1;
    for (const std::vector<double>& row : rows_) count *= CountOrders(row);
    if (count > static_cast<double>(most)) return false;
    probability_ = 1 / count;
    Descend(0, evidence_of, take);
    return true;
  }

 private:
  /// n! over the factorials of the numbers of equal values.
  static double CountOrders(const std::vector<double>& sorted) {
    double count = 1, equal = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      equal = i > 0 && sorted[i] == sorted[i - 1] ? equal + 1 : 1;
      count *= static_cast<double>(i + 1) / equal;
    }
    return count;
  }

  void Descend(std::size_t subject, const EvidenceOfSums& evidence_of, const TakeEvidence& take) {
    if (subject == rows_.size()) {
      evidence_of(sums_, evidence_);
      take(evidence_, probability_);
      return;
    }
    std::vector<double> row = rows_[subject];
    const std::vector<double> before = sums_;
    do {
      for (std::size_t i = 0; i < row.size(); ++i) sums_[i] = before[i] + row[i];
      Descend(subject + 1, evidence_of, take);
    } while (std::next_permutation(row.begin(), row.end()));
    sums_ = before;
  }

  Rows rows_;
  std::vector<double> sums_;
  std::vector<double> evidence_;
  double probability_ = 1;
};

std::vector<double> ColumnSums(const Rows& rows) {
  std::vector<double> sums(rows.front().size(), 0.0);
  for (const std::vector<double>& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) sums[i] += row[i];
  }
  return sums;
}

Result<Relabelled> RelabelRows(const Rows& rows, double tolerance, const Relabelling& relabelling,
                               const EvidenceOfSums& evidence_of) {
  RowOrders orders(rows);
  Rows shuffled = rows;
  std::vector<double> observed, drawn;
  evidence_of(ColumnSums(rows), observed);
  return CompareWithRelabellings(
      observed, tolerance, relabelling,
      [&](std::size_t most, const TakeEvidence& take) {
        return orders.RunThrough(most, evidence_of, take);
      },
      [&](std::mt19937_64& engine) -> const std::vector<double>& {
        for (std::vector<double>& row : shuffled) Shuffle(row, engine);
        evidence_of(ColumnSums(shuffled), drawn);
        return drawn;
      });
}

/// Square distances of rank sums from their mean: all that varies in Friedman's statistic.
double SquareDistances(const std::vector<double>& sums) {
  const double mean = Mean(sums);
  double squares = 0;
  for (const double sum : sums) squares += (sum - mean) * (sum - mean);
  return squares;
}

}  // namespace

Result<MeanDifferences> PermuteWithinSubjects(const Blocks& blocks, Alternative alternative,
                                              const Relabelling& relabelling) {
  FOOTING_CHECK(!blocks.values.empty() && blocks.groups.size() > 1);
  // A subject's own level is the same under all its relabellings.
  Rows rows = blocks.values;
  double widths = 0;
  for (std::vector<double>& row : rows) {
    const auto [least, greatest] = std::minmax_element(row.begin(), row.end());
    widths += *greatest - *least;
    const double level = *least;
    for (double& value : row) value -= level;
  }
  const double n = static_cast<double>(rows.size());
  const auto evidence_of = [&](const std::vector<double>& sums, std::vector<double>& evidence) {
    evidence.clear();
    for (std::size_t i = 1; i < sums.size(); ++i) {
      evidence.push_back(Evidence((sums[i] - sums[0]) / n, alternative));
    }
  };
  constexpr double kRounding = 1e-12;
  auto relabelled = RelabelRows(rows, kRounding * widths / n, relabelling, evidence_of);
  if (!relabelled) return relabelled.error();
  MeanDifferences result;
  result.relabelled = std::move(relabelled).value();
  for (std::size_t i = 1; i < blocks.groups.size(); ++i) {
    result.estimates.push_back(Mean(Differences(blocks, i)));
  }
  return result;
}

Result<Friedman> FriedmanTest(const Blocks& blocks, const Relabelling& relabelling) {
  FOOTING_CHECK(!blocks.values.empty() && blocks.groups.size() > 1);
  Rows ranks;
  double tie_sums = 0;
  for (const std::vector<double>& row : blocks.values) {
    MeanRanks ranked = RankWithTies(row);
    ranks.push_back(std::move(ranked.ranks));
    tie_sums += ranked.tie_sum;
  }
  const std::vector<double> sums = ColumnSums(ranks);
  const double n = static_cast<double>(ranks.size());
  const double groups = static_cast<double>(blocks.groups.size());
  Friedman test;
  test.degrees = groups - 1;
  const double scale = n * groups * (groups + 1) - tie_sums / (groups - 1);
  if (scale > 0.5) test.chi_square = 12 * SquareDistances(sums) / scale;
  test.p = ChiSquareTail(test.chi_square, test.degrees);
  for (std::size_t i = 1; i < sums.size(); ++i) {
    test.many_one_z.push_back((sums[i] - sums[0]) / std::sqrt(n * groups * (groups + 1) / 6));
  }
  constexpr double kBetweenRankSums = 1e-6;  // Their squares differ by far more.
  const auto relabelled =
      RelabelRows(ranks, kBetweenRankSums, relabelling,
                  [](const std::vector<double>& column_sums, std::vector<double>& evidence) {
                    evidence.assign(1, SquareDistances(column_sums));
                  });
  if (!relabelled) return relabelled.error();
  test.relabelled_p = relabelled->rows.front().p;
  return test;
}

std::vector<double> Differences(const Blocks& blocks, std::size_t treatment) {
  std::vector<double> differences;
  for (const std::vector<double>& row : blocks.values) {
    constexpr double kRounding = 4e-16;
    const double size = std::max(std::abs(row[0]), std::abs(row[treatment]));
    const double difference = row[treatment] - row[0];
    differences.push_back(std::abs(difference) <= kRounding * size ? 0 : difference);
  }
  return differences;
}

std::vector<double> Holm(const std::vector<double>& p) {
  std::vector<std::size_t> order(p.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return p[a] < p[b]; });
  std::vector<double> adjusted(p.size());
  double greatest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    greatest = std::max(greatest, p[order[i]] * static_cast<double>(order.size() - i));
    adjusted[order[i]] = std::min(1.0, greatest);
  }
  return adjusted;
}

namespace {

/// All sums of one value of each list, in order, without making them: two indices walk through the
/// sorted lists.
class PairSums {
 public:
  /// With `unordered` both lists are the same one, and a pair and its mirror image count once.
  PairSums(std::vector<double> a, std::vector<double> b, bool unordered)
      : a_(std::move(a)), b_(std::move(b)), unordered_(unordered) {
    std::sort(a_.begin(), a_.end());
    std::sort(b_.begin(), b_.end());
  }

  double count() const {
    const double n = static_cast<double>(a_.size());
    return unordered_ ? n * (n + 1) / 2 : n * static_cast<double>(b_.size());
  }

  /// The sum of this rank, from 1 to count().
  double OfRank(double rank) const {
    double low = a_.front() + b_.front(), high = a_.back() + b_.back();
    if (CountAtMost(low) >= rank) return low;
    for (;;) {
      const double middle = low + (high - low) / 2;
      if (middle <= low || middle >= high) return GreatestAtMost(high);
      (CountAtMost(middle) >= rank ? high : low) = middle;
    }
  }

  double Median() const {
    const double n = count();
    const double low = OfRank(std::floor((n + 1) / 2));
    const double high = OfRank(std::floor(n / 2) + 1);
    return low + (high - low) / 2;
  }

 private:
  double CountAtMost(double sum) const {
    double pairs = 0, twins = 0;
    std::size_t end = b_.size();
    for (const double value : a_) {
      while (end > 0 && value + b_[end - 1] > sum) --end;
      pairs += static_cast<double>(end);
      twins += unordered_ && value + value <= sum ? 1 : 0;
    }
    return unordered_ ? (pairs + twins) / 2 : pairs;
  }

  double GreatestAtMost(double sum) const {
    double greatest = a_.front() + b_.front();
    std::size_t end = b_.size();
    for (const double value : a_) {
      while (end > 0 && value + b_[end - 1] > sum) --end;
      if (end > 0) greatest = std::max(greatest, value + b_[end - 1]);
    }
    return greatest;
  }

  std::vector<double> a_, b_;
  bool unordered_;
};

/// Where the rank statistic of the sums has this mean and deviation.
EffectSize MedianAndInterval(const PairSums& sums, double mean, double deviation, double z) {
  EffectSize effect;
  effect.estimate = sums.Median();
  const double rank = std::floor(mean - z * deviation + 0.5);
  if (rank >= 1) effect.interval = {sums.OfRank(rank), sums.OfRank(sums.count() + 1 - rank)};
  return effect;
}

/// The asymmetric interval of a delta with this variance, from samples of which the smallest has
/// `n` values.
EffectSize DeltaWithInterval(double delta, double variance, double n, double z) {
  const double square = z * z;
  if (std::abs(delta) >= 1) {
    const double bound = (n - square) / (n + square);
    return delta > 0 ? EffectSize{1, {bound, 1}} : EffectSize{-1, {-1, -bound}};
  }
  const double rest = 1 - delta * delta;
  const double divisor = rest + square * variance;
  const double centre = delta * rest;
  const double reach = z * std::sqrt(variance * (rest * rest + square * variance));
  return {delta,
          {std::max(-1.0, (centre - reach) / divisor), std::min(1.0, (centre + reach) / divisor)}};
}

/// Dominance of each value: the share of `others` (sorted) below it less the share above it.
std::vector<double> Dominances(const std::vector<double>& values,
                               const std::vector<double>& others) {
  std::vector<double> dominances;
  for (const double value : values) {
    const auto [first, last] = std::equal_range(others.begin(), others.end(), value);
    dominances.push_back(static_cast<double>((first - others.begin()) - (others.end() - last)) /
                         static_cast<double>(others.size()));
  }
  return dominances;
}

/// Sum of squares about the mean over n - 1.
double Variance(const std::vector<double>& values) {
  const double mean = Mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / (static_cast<double>(values.size()) - 1);
}

}  // namespace

EffectSize HodgesLehmann(const std::vector<double>& control, const std::vector<double>& treatment,
                         double z) {
  FOOTING_CHECK(!control.empty() && !treatment.empty());
  std::vector<double> negated;
  for (const double value : control) negated.push_back(-value);
  const PairSums sums(std::move(negated), treatment, false);
  const double all = static_cast<double>(control.size() + treatment.size());
  return MedianAndInterval(sums, sums.count() / 2, std::sqrt(sums.count() * (all + 1) / 12), z);
}

EffectSize PairedHodgesLehmann(const std::vector<double>& differences, double z) {
  FOOTING_CHECK(!differences.empty());
  std::vector<double> halves;
  for (const double difference : differences) halves.push_back(difference / 2);
  const double n = static_cast<double>(differences.size());
  return MedianAndInterval(PairSums(halves, halves, true), n * (n + 1) / 4,
                           std::sqrt(n * (n + 1) * (2 * n + 1) / 24), z);
}

EffectSize CliffsDelta(const std::vector<double>& control, const std::vector<double>& treatment,
                       double z) {
  FOOTING_CHECK(!control.empty() && !treatment.empty());
  std::vector<double> sorted_control = control, sorted_treatment = treatment;
  std::sort(sorted_control.begin(), sorted_control.end());
  std::sort(sorted_treatment.begin(), sorted_treatment.end());
  const double m = static_cast<double>(control.size());
  const double n = static_cast<double>(treatment.size());
  const std::vector<double> of_treatment = Dominances(treatment, sorted_control);
  const std::vector<double> of_control = Dominances(control, sorted_treatment);
  const double delta = Mean(of_treatment);
  if (m < 2 || n < 2) return {delta, {-1, 1}};
  // The squares of single pairs are 1, or 0 where tied.
  double ties = 0;
  for (const double value : treatment) {
    const auto [first, last] =
        std::equal_range(sorted_control.begin(), sorted_control.end(), value);
    ties += static_cast<double>(last - first);
  }
  const double of_pairs = (m * n - ties - m * n * delta * delta) / ((m - 1) * (n - 1));
  const double variance =
      ((m - 1) * Variance(of_treatment) + (n - 1) * Variance(of_control) + of_pairs) / (m * n);
  return DeltaWithInterval(delta, variance, std::min(m, n), z);
}

EffectSize PairedDelta(const std::vector<double>& differences, double z) {
  FOOTING_CHECK(!differences.empty());
  std::vector<double> signs;
  for (const double difference : differences) {
    signs.push_back(difference > 0 ? 1 : difference < 0 ? -1 : 0);
  }
  const double n = static_cast<double>(signs.size());
  const double delta = Mean(signs);
  if (signs.size() < 2) return {delta, {-1, 1}};
  return DeltaWithInterval(delta, Variance(signs) / n, n, z);
}

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

namespace {

constexpr std::size_t kMostExact = 200;
constexpr std::size_t kExactInR = 50;  // wilcox.test is normal from here on.

/// Sizes that differ by rounding only are tied: 0.3 - 0.1 and 0.2.
MeanRanks RankSizes(std::vector<double> differences) {
  constexpr double kSizeRounding = 1e-12;
  for (double& difference : differences) difference = std::abs(difference);
  return RankWithTies(differences, kSizeRounding);
}

/// P(V <= v) and P(V >= v).
struct BothTails {
  double lower = 1;
  double upper = 1;
};

/// Over all signs of these ranks. Twice a mean rank is a whole number.
BothTails ExactTails(const std::vector<double>& ranks, double v) {
  std::size_t greatest = 0;
  std::vector<std::size_t> doubled;
  for (const double rank : ranks) {
    doubled.push_back(static_cast<std::size_t>(std::lround(2 * rank)));
    greatest += doubled.back();
  }
  std::vector<double> shares(greatest + 1, 0.0);
  shares[0] = 1;
  std::size_t reached = 0;
  for (const std::size_t rank : doubled) {
    reached += rank;
    for (std::size_t sum = reached + 1; sum-- > 0;) {
      shares[sum] = shares[sum] / 2 + (sum >= rank ? shares[sum - rank] / 2 : 0);
    }
  }
  const auto observed = static_cast<std::size_t>(std::lround(2 * v));
  BothTails tails{0, 0};
  for (std::size_t sum = 0; sum <= greatest; ++sum) {
    if (sum <= observed) tails.lower += shares[sum];
    if (sum >= observed) tails.upper += shares[sum];
  }
  return tails;
}

double Chosen(const BothTails& tails, Alternative alternative) {
  switch (alternative) {
    case Alternative::kTwoSided:
      return std::min(1.0, 2 * std::min(tails.lower, tails.upper));
    case Alternative::kGreater:
      return std::min(1.0, tails.upper);
    case Alternative::kLess:
      return std::min(1.0, tails.lower);
  }
  return 1;
}

/// With the correction for continuity: v is moved half a rank towards its mean.
double NormalP(double n, double tie_sum, double v, Alternative alternative) {
  const double distance = v - n * (n + 1) / 4;
  const double deviation = std::sqrt(n * (n + 1) * (2 * n + 1) / 24 - tie_sum / 48);
  if (!(deviation > 0)) return 1;
  switch (alternative) {
    case Alternative::kTwoSided: {
      const double step = distance > 0 ? 0.5 : distance < 0 ? -0.5 : 0;
      return std::min(1.0, 2 * NormalTail(std::abs(distance - step) / deviation));
    }
    case Alternative::kGreater:
      return NormalTail((distance - 0.5) / deviation);
    case Alternative::kLess:
      return NormalTail((-distance - 0.5) / deviation);
  }
  return 1;
}

}  // namespace

SignedRanks WilcoxonTest(const std::vector<double>& differences, Alternative alternative) {
  std::vector<double> full;
  for (const double difference : differences) {
    if (difference != 0) full.push_back(difference);
  }
  SignedRanks test;
  if (full.empty()) return test;
  const MeanRanks sizes = RankSizes(full);
  for (std::size_t i = 0; i < full.size(); ++i) {
    if (full[i] > 0) test.v += sizes.ranks[i];
  }
  const double normal_p =
      NormalP(static_cast<double>(full.size()), sizes.tie_sum, test.v, alternative);
  test.exact_p =
      full.size() <= kMostExact ? Chosen(ExactTails(sizes.ranks, test.v), alternative) : normal_p;
  const bool plain = sizes.tie_sum == 0 && full.size() == differences.size();
  test.p = plain && full.size() < kExactInR ? test.exact_p : normal_p;
  return test;
}

double NormalTail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

double NormalUpperQuantile(double tail) {
  return std::numbers::sqrt2 * boost::math::erfc_inv(2 * tail);
}

double ChiSquareTail(double x, double degrees) {
  return x <= 0 ? 1 : boost::math::gamma_q(degrees / 2, x / 2);
}

double BinomialUpperTail(double successes, double trials, double share) {
  return successes <= 0 ? 1 : boost::math::ibeta(successes, trials - successes + 1, share);
}

double BetaQuantile(double probability, double a, double b) {
  return boost::math::ibeta_inv(a, b, probability);
}

double FindRoot(const std::function<double(double)>& function, double low, double high) {
  const double at_low = function(low);
  const double at_high = function(high);
  if (at_low == 0) return low;
  if (at_high == 0) return high;
  constexpr int kBits = 42;
  std::uintmax_t evaluations = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      function, low, high, at_low, at_high, boost::math::tools::eps_tolerance<double>(kBits),
      evaluations);
  return (bracket.first + bracket.second) / 2;
}

}  // namespace footing::statistics
