#include "common/statistics/negative_binomial.h"

#include <algorithm>
#include <cmath>

namespace footing::statistics {
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
