#include "common/statistics/effect_sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/result.h"
#include "common/statistics/moments.h"

namespace footing::statistics {
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

/// Of each value: the share of `others` (sorted) below it less the share above it.
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

}  // namespace footing::statistics
