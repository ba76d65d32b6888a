#include "common/statistics/rate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/statistics/negative_binomial.h"
#include "common/statistics/special.h"
#include "common/statistics/within_subject.h"

namespace footing::statistics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kFarthestLogRatio = 90;  // 1e39: a million events, exposures from 1e-9 to 1e9.

struct Total {
  double events = 0;
  double exposure = 0;
  double rate() const { return events / exposure; }
};

Total TotalOf(const Counts& group) {
  FOOTING_CHECK(!group.events.empty() && group.events.size() == group.exposures.size());
  Total total;
  for (const double events : group.events) total.events += events;
  for (const double exposure : group.exposures) total.exposure += exposure;
  return total;
}

/// 0 / 0 is NaN: nothing is known.
double Over(double numerator, double denominator) {
  if (denominator > 0) return numerator / denominator;
  return numerator > 0 ? kInfinity : std::numeric_limits<double>::quiet_NaN();
}

/// Given the sum of events the treatment's are binomial with the share pi = r e_i / (r e_i + e_0)
/// at the ratio r.
RateRatio ExactPoisson(const Total& control, const Total& treatment, Alternative alternative,
                       double tail) {
  RateRatio result;
  result.statistic = treatment.events;
  const double sum = control.events + treatment.events;
  if (sum == 0) {
    result.interval.low = 0;
    return result;
  }
  const double share = treatment.exposure / (treatment.exposure + control.exposure);
  const double upper = BinomialUpperTail(treatment.events, sum, share);
  const double lower = BinomialUpperTail(control.events, sum, 1 - share);
  switch (alternative) {
    case Alternative::kTwoSided:
      result.unadjusted_p = std::min(1.0, 2 * std::min(lower, upper));
      break;
    case Alternative::kGreater:
      result.unadjusted_p = upper;
      break;
    case Alternative::kLess:
      result.unadjusted_p = lower;
      break;
  }
  const double exposures = control.exposure / treatment.exposure;
  const double low =
      treatment.events > 0 ? BetaQuantile(tail, treatment.events, control.events + 1) : 0;
  result.interval.low = low / (1 - low) * exposures;
  if (control.events > 0) {
    const double high = BetaQuantile(1 - tail, treatment.events + 1, control.events);
    result.interval.high = high / (1 - high) * exposures;
  }
  return result;
}

/// Where the profile has fallen by z^2 / 2, in direction `step` of the log ratio; infinite when it
/// does not within any ratio that counts and exposures allow. `start` is the log ratio of the peak,
/// or any one where the peak is at infinity against the direction.
double ProfileEnd(const std::function<double(double)>& excess, double start, double step) {
  double inner = start;
  for (double back = step; excess(inner) > 0; back *= 2) {
    if (std::abs(inner) > kFarthestLogRatio) return inner;  // Rounding: flat to the end.
    inner -= back;
  }
  double outer = inner + step;
  while (!(excess(outer) > 0)) {
    if (std::abs(outer) > kFarthestLogRatio) return step > 0 ? kInfinity : -kInfinity;
    inner = outer;
    step *= 2;
    outer += step;
  }
  return FindRoot(excess, std::min(inner, outer), std::max(inner, outer));
}

RateRatio ProfileRatio(const NegativeBinomial& model, std::size_t group, Alternative alternative,
                       double tail) {
  RateRatio result;
  const double ratio = Over(model.rate(group), model.rate(0));
  if (std::isnan(ratio)) {
    result.interval.low = 0;
    return result;
  }
  const double peak = model.greatest_log_likelihood();
  const double drop = std::max(0.0, peak - model.Profile(group, 1));
  result.statistic = (ratio < 1 ? -1 : 1) * std::sqrt(2 * drop);
  const double p = NormalTail(Evidence(result.statistic, alternative));
  result.unadjusted_p = alternative == Alternative::kTwoSided ? std::min(1.0, 2 * p) : p;
  const double z = NormalUpperQuantile(tail);
  const auto excess = [&](double log_ratio) {
    return 2 * (peak - model.Profile(group, std::exp(log_ratio))) - z * z;
  };
  const double top = ratio == 0 || std::isinf(ratio) ? 0 : std::log(ratio);
  if (ratio > 0 && alternative != Alternative::kLess) {
    result.interval.low = std::exp(ProfileEnd(excess, top, -0.5));
  }
  if (!std::isinf(ratio) && alternative != Alternative::kGreater) {
    result.interval.high = std::exp(ProfileEnd(excess, top, 0.5));
  }
  return result;
}

/// Pearson's chi-square of the Poisson model.
void AddDispersionTest(const std::vector<Counts>& groups, Rates& rates) {
  double chi_square = 0, degrees = 0;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (rates.rates[i] == 0) continue;  // It has no variance to compare.
    for (std::size_t j = 0; j < groups[i].events.size(); ++j) {
      const double mean = rates.rates[i] * groups[i].exposures[j];
      chi_square += (groups[i].events[j] - mean) * (groups[i].events[j] - mean) / mean;
    }
    degrees += static_cast<double>(groups[i].events.size()) - 1;
  }
  if (degrees < 1) return;
  rates.pearson_ratio = chi_square / degrees;
  rates.overdispersion_p = ChiSquareTail(chi_square, degrees);
}

void AdjustByHolm(std::vector<RateRow>& rows, RateRatio RateRow::*part) {
  std::vector<double> p;
  for (const RateRow& row : rows) p.push_back((row.*part).unadjusted_p);
  const std::vector<double> adjusted = Holm(p);
  for (std::size_t i = 0; i < rows.size(); ++i) (rows[i].*part).p = adjusted[i];
}

}  // namespace

Rates CompareRates(const std::vector<Counts>& groups, Alternative alternative, double confidence) {
  FOOTING_CHECK(groups.size() > 1);
  Rates result;
  std::vector<Total> totals;
  for (const Counts& group : groups) {
    totals.push_back(TotalOf(group));
    result.rates.push_back(totals.back().rate());
  }
  AddDispersionTest(groups, result);
  const NegativeBinomial model(groups);
  result.dispersion = model.dispersion();
  const double comparisons = static_cast<double>(groups.size() - 1);
  const double sides = alternative == Alternative::kTwoSided ? 2 : 1;
  const double tail = (1 - confidence) / comparisons / sides;
  for (std::size_t i = 1; i < groups.size(); ++i) {
    RateRow& row = result.rows.emplace_back();
    row.ratio = Over(result.rates[i], result.rates[0]);
    row.negative_binomial_ratio = Over(model.rate(i), model.rate(0));
    row.poisson = ExactPoisson(totals[0], totals[i], alternative, tail);
    row.negative_binomial = ProfileRatio(model, i, alternative, tail);
    for (RateRatio* ratio : {&row.poisson, &row.negative_binomial}) {
      ratio->interval.low = std::max(0.0, ratio->interval.low);
      ratio->interval = Directed(ratio->interval, alternative, {0, kInfinity});
    }
  }
  AdjustByHolm(result.rows, &RateRow::poisson);
  AdjustByHolm(result.rows, &RateRow::negative_binomial);
  return result;
}

}  // namespace footing::statistics
