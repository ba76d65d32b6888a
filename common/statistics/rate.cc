#include "common/statistics/rate.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace {

/// exp of these ends; below the lower one the model is Poisson's to 8 digits.
constexpr double kLogDispersionLow = -18;
constexpr double kLogDispersionHigh = 7;
constexpr int kGrid = 25;
/// Counts up to here enter the sum over j one by one; greater ones by the gamma function.
constexpr std::size_t kMostSummed = 2000;

/// Counts that share a rate but for a factor that is known for each.
struct Shared {
  std::vector<double> events;
  std::vector<double> factors;

  void Add(const Counts& group, double factor) {
    events.insert(events.end(), group.events.begin(), group.events.end());
    for (const double exposure : group.exposures) factors.push_back(factor * exposure);
  }
};

/// The rate of the greatest likelihood: where sum (x - mu) / (1 + a mu) = 0. The likelihood is
/// concave in log rate; Newton's steps stay in a bracket.
double SolveRate(const Shared& shared, double a) {
  double events = 0, exposure = 0;
  for (std::size_t i = 0; i < shared.events.size(); ++i) {
    events += shared.events[i];
    exposure += shared.factors[i];
  }
  if (events == 0) return 0;
  double eta = std::log(events / exposure);
  double low = eta, high = eta;
  for (std::size_t i = 0; i < shared.events.size(); ++i) {
    if (shared.events[i] == 0) low = std::min(low, eta - 50);
    const double own = std::log(std::max(shared.events[i], 1e-12) / shared.factors[i]);
    low = std::min(low, own);
    high = std::max(high, own);
  }
  for (int i = 0; i < 100; ++i) {
    double score = 0, slope = 0;
    for (std::size_t j = 0; j < shared.events.size(); ++j) {
      const double mean = shared.factors[j] * std::exp(eta);
      const double divisor = 1 + a * mean;
      score += (shared.events[j] - mean) / divisor;
      slope -= mean * (1 + a * shared.events[j]) / (divisor * divisor);
    }
    (score > 0 ? low : high) = eta;
    double next = eta - score / slope;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (std::abs(next - eta) < 1e-13 * (1 + std::abs(eta))) return std::exp(next);
    eta = next;
  }
  return std::exp(eta);
}

/// The terms in mu.
double LogLikelihood(const Shared& shared, double rate, double a) {
  double sum = 0;
  for (std::size_t i = 0; i < shared.events.size(); ++i) {
    const double mean = shared.factors[i] * rate;
    if (mean == 0) continue;  // Without events; with events the rate is not 0.
    const double x = shared.events[i];
    sum += x * std::log(mean) - (x + 1 / a) * std::log1p(a * mean);
  }
  return sum;
}

double GreatestLogLikelihood(const Shared& shared, double a) {
  return LogLikelihood(shared, SolveRate(shared, a), a);
}

}  // namespace

NegativeBinomial::NegativeBinomial(const std::vector<Counts>& groups) : groups_(groups) {
  for (const Counts& group : groups) {
    for (const double events : group.events) {
      const auto summed = std::min(static_cast<std::size_t>(events), kMostSummed);
      if (at_least_.size() < summed) at_least_.resize(summed, 0.0);
      for (std::size_t j = 0; j < summed; ++j) ++at_least_[j];
    }
  }
  std::vector<Shared> apart(groups.size());
  for (std::size_t i = 0; i < groups.size(); ++i) apart[i].Add(groups[i], 1);
  const Maximum maximum = OverDispersions([&](double a) {
    double sum = 0;
    for (const Shared& shared : apart) sum += GreatestLogLikelihood(shared, a);
    return sum;
  });
  greatest_ = maximum.value;
  dispersion_ = maximum.at;
  for (const Shared& shared : apart) rates_.push_back(SolveRate(shared, dispersion_));
}

double NegativeBinomial::Profile(std::size_t group, double ratio) const {
  std::vector<Shared> shared(1);
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const bool tied = i == 0 || i == group;
    if (!tied) shared.emplace_back();
    (tied ? shared.front() : shared.back()).Add(groups_[i], i == group ? ratio : 1);
  }
  return OverDispersions([&](double a) {
           double sum = 0;
           for (const Shared& one : shared) sum += GreatestLogLikelihood(one, a);
           return sum;
         })
      .value;
}

double NegativeBinomial::Constant(double dispersion) const {
  double sum = 0;
  for (std::size_t j = 0; j < at_least_.size(); ++j) {
    sum += at_least_[j] * std::log1p(dispersion * static_cast<double>(j));
  }
  const double size = 1 / dispersion;
  constexpr double kFirst = static_cast<double>(kMostSummed);
  for (const Counts& group : groups_) {
    for (const double events : group.events) {
      if (events <= kFirst) continue;
      sum += std::lgamma(events + size) - std::lgamma(kFirst + size) +
             (events - kFirst) * std::log(dispersion);
    }
  }
  return sum;
}

/// A grid finds the hill, golden sections its top.
template <typename Function>
NegativeBinomial::Maximum NegativeBinomial::OverDispersions(const Function& log_likelihood) const {
  const auto value = [&](double log_a) {
    const double a = std::exp(log_a);
    return Constant(a) + log_likelihood(a);
  };
  constexpr double kSpacing = (kLogDispersionHigh - kLogDispersionLow) / kGrid;
  double best = kLogDispersionLow, best_value = value(best);
  for (int i = 1; i <= kGrid; ++i) {
    const double at = kLogDispersionLow + i * kSpacing;
    const double here = value(at);
    if (here > best_value) {
      best = at;
      best_value = here;
    }
  }
  double low = std::max(best - kSpacing, kLogDispersionLow);
  double high = std::min(best + kSpacing, kLogDispersionHigh);
  constexpr double kGolden = 0.6180339887498949;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = value(left), at_right = value(right);
  while (high - low > 1e-7) {
    if (at_left > at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = value(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = value(right);
    }
  }
  const double top = (low + high) / 2;
  const double at_top = value(top);
  if (at_top > best_value) {
    best = top;
    best_value = at_top;
  }
  return {best <= kLogDispersionLow ? 0 : std::exp(best), best_value};
}

}  // namespace footing::statistics
