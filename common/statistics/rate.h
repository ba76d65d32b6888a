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
  double unadjusted_p = 1;  ///< Of this comparison alone.
  double p = 1;             ///< By Holm's adjustment for all comparisons.
  Interval interval;        ///< Simultaneous by Bonferroni.
};

struct RateRow {
  double ratio = 0;  ///< Estimate under the Poisson model: events per exposure.
  RateRatio poisson;
  double negative_binomial_ratio = 0;
  RateRatio negative_binomial;
};

struct Rates {
  std::vector<double> rates;    ///< Of the groups, the control's first: events per exposure.
  double pearson_ratio = 0;     ///< Pearson's chi-square over its degrees: 1 under Poisson.
  double overdispersion_p = 1;  ///< P of a chi-square as great under Poisson.
  /// Of the negative binomial model: variance = mean + dispersion mean^2. 0: Poisson.
  double dispersion = 0;
  std::vector<RateRow> rows;
};

/// Poisson: given the sum of both groups the treatment's events are binomial; p is twice the
/// smaller tail, and the interval is Clopper and Pearson's. Negative binomial: one dispersion for
/// all groups by maximum likelihood; p and interval by the profile likelihood.
Rates CompareRates(const std::vector<Counts>& groups, Alternative alternative, double confidence);

}  // namespace footing::statistics
