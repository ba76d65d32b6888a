#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/statistics/samples.h"

/// Rates of counted events: how many times more often something happens than with the control.
namespace footing::statistics {

/// Counts of events, each with its exposure: minutes, metres, attempts, or 1.
struct Counts {
  std::vector<double> events;     ///< Whole numbers, at most kMostEvents.
  std::vector<double> exposures;  ///< Positive, as many.
};
inline constexpr double kMostEvents = 1e6;

/// A rate over the control's. Both ends can be open, and an estimate 0 or infinite (NaN where both
/// groups are without events).
struct RateRatio {
  double statistic = 0;     ///< Signed root of the likelihood ratio; exact test: events.
  double unadjusted_p = 1;  ///< P of this comparison alone.
  double p = 1;             ///< By Holm's adjustment for all comparisons.
  Interval interval;        ///< Simultaneous by Bonferroni.
};

/// One treatment's rate against the control's, under both models.
struct RateRow {
  double ratio = 0;  ///< Estimate under the Poisson model: events per exposure.
  RateRatio poisson;
  double negative_binomial_ratio = 0;
  RateRatio negative_binomial;
};

/// Result of the comparison of rates, a row a treatment.
struct Rates {
  std::vector<double> rates;    ///< Rates of the groups, the control's first: events per exposure.
  double pearson_ratio = 0;     ///< Pearson's chi-square over its degrees: 1 under Poisson.
  double overdispersion_p = 1;  ///< P of a chi-square as great under Poisson.
  /// Dispersion of the negative binomial model: variance = mean + dispersion mean^2. 0: Poisson.
  double dispersion = 0;
  std::vector<RateRow> rows;
};

/// Poisson: given the sum of both groups the treatment's events are binomial; p is twice the
/// smaller tail, and the interval is Clopper and Pearson's. Negative binomial: one dispersion for
/// all groups by maximum likelihood; p and interval by the profile likelihood.
Rates CompareRates(const std::vector<Counts>& groups, Alternative alternative, double confidence);

/// Maximum likelihood of counts with one dispersion a and a rate for each group.
///
///   | symbol | name here  | meaning                                        |
///   | x      | events     |                                                |
///   | mu     | mean       | rate times exposure                            |
///   | a      | dispersion | variance = mu + a mu^2; 0: the Poisson model   |
///
/// log L = sum over x of [sum over j < x of log(1 + a j)] + x log mu - (x + 1/a) log(1 + a mu)
class NegativeBinomial {
 public:
  /// `groups` must outlive it.
  explicit NegativeBinomial(const std::vector<Counts>& groups);

  double greatest_log_likelihood() const { return greatest_; }
  double dispersion() const { return dispersion_; }
  /// Rate of the greatest likelihood: 0 for a group without events.
  double rate(std::size_t group) const { return rates_[group]; }

  /// The greatest log likelihood where the rate of `group` is `ratio` times the control's.
  double Profile(std::size_t group, double ratio) const;

 private:
  struct Maximum {
    double at = 0;
    double value = 0;
  };
  template <typename Function>
  Maximum OverDispersions(const Function& log_likelihood) const;
  /// Without the terms in mu: sum over x, j < x of log(1 + a j).
  double Constant(double dispersion) const;

  const std::vector<Counts>& groups_;
  std::vector<double> at_least_;  ///< How many counts exceed j, for j = 0, 1, ...
  double greatest_ = 0;
  double dispersion_ = 0;
  std::vector<double> rates_;
};

}  // namespace footing::statistics
