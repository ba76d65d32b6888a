#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "common/base/result.h"
#include "common/statistics/samples.h"

/// Tests for designs where every subject has one value in every group.
namespace footing::statistics {

/// Mean of each treatment less the control's, with adjusted p: labels are permuted within each
/// subject, and the evidence is the greatest (absolute) difference of means.
struct MeanDifferences {
  std::vector<double> estimates;
  Relabelled relabelled;
};
Result<MeanDifferences> PermuteWithinSubjects(const Blocks& blocks, Alternative alternative,
                                              const Relabelling& relabelling);

/// Does any group differ? Ranks within each subject; ties share their mean rank.
struct Friedman {
  double chi_square = 0;  ///< With the correction for ties; 0 where all ranks are tied.
  double degrees = 0;
  double p = 1;             ///< By the chi-square distribution.
  double relabelled_p = 1;  ///< By relabelling within subjects.
  /// (R_i - R_0) / sqrt(n g (g + 1) / 6) of each treatment, with rank sums R and g groups.
  std::vector<double> many_one_z;
};
Result<Friedman> FriedmanTest(const Blocks& blocks, const Relabelling& relabelling);

/// Wilcoxon's signed ranks of one list of differences.
struct SignedRanks {
  double v = 0;        ///< Sum of the ranks of positive differences; zeros are left out.
  double exact_p = 1;  ///< Over all signs, with ties as they are. Normal above 200 differences.
  /// As R's wilcox.test: exact below 50 differences without ties or zeros, otherwise normal with
  /// continuity and tie corrections.
  double p = 1;
};
SignedRanks WilcoxonTest(const std::vector<double>& differences, Alternative alternative);

/// Holm's step-down adjustment.
std::vector<double> Holm(const std::vector<double>& p);

/// Differences of a treatment (index in `blocks.groups`) less the control, one for each subject.
/// A difference that rounding leaves of equal values counts as 0.
std::vector<double> Differences(const Blocks& blocks, std::size_t treatment);

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

/// How large a difference is, beside whether there is one. `z` is the critical value of the
/// interval: the one of all comparisons together makes the intervals simultaneous.
struct EffectSize {
  double estimate = 0;
  Interval interval;
};

/// Hodges-Lehmann: the median of all differences between a treatment's value and a control's. The
/// ends are such differences, too, by the normal approximation of U; an end is open where the
/// groups are too small for it.
EffectSize HodgesLehmann(const std::vector<double>& control, const std::vector<double>& treatment,
                         double z);

/// The median of the means of every two differences, each with itself too, with an interval by the
/// normal approximation of the signed ranks.
EffectSize PairedHodgesLehmann(const std::vector<double>& differences, double z);

/// Cliff's delta: the share of pairs where the treatment's value is greater, less the share where
/// it is smaller. The interval is asymmetric (Feng & Cliff 2004) and stays within [-1, 1].
EffectSize CliffsDelta(const std::vector<double>& control, const std::vector<double>& treatment,
                       double z);

/// The same within subjects: the share of positive differences less that of negative ones.
EffectSize PairedDelta(const std::vector<double>& differences, double z);

/// Ranks from 1; tied values share the mean of theirs.
struct MeanRanks {
  std::vector<double> ranks;  ///< In the order of the values.
  double tie_sum = 0;         ///< Sum of t^3 - t over the groups of t tied values.
};

/// Values above the least one of a group by at most this share of it are tied; 0: equal ones, and
/// values may be negative.
MeanRanks RankWithTies(const std::vector<double>& values, double tied_share = 0);

/// P(Z > z) of a standard normal Z, with its relative accuracy far out.
double NormalTail(double z);
/// The z with NormalTail(z) = `tail`, which is in (0, 1).
double NormalUpperQuantile(double tail);

/// P(X > x) of a chi-square variable; 1 for x <= 0. `degrees` > 0.
double ChiSquareTail(double x, double degrees);

/// P(X >= successes) of a binomial variable: `trials` >= `successes` >= 0, `share` in [0, 1].
double BinomialUpperTail(double successes, double trials, double share);
/// The x with P(X <= x) = `probability` of a beta variable; a, b > 0.
double BetaQuantile(double probability, double a, double b);

/// The zero of a continuous function between two places where its signs differ, to 12 digits.
double FindRoot(const std::function<double(double)>& function, double low, double high);

}  // namespace footing::statistics
