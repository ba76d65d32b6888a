#include "common/statistics/many_to_one.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/base/result.h"
#include "common/statistics/special.h"

namespace footing::statistics {
namespace {

/// All integrands are analytic and vanish at both ends, where the trapezoidal rule converges
/// faster than Gauss rules: for a Gaussian of width w and the step h the error is
/// exp(-2 (pi w / h)^2). The steps leave a margin for products of many factors.
constexpr double kStepY = 0.4;  // In units of the sharpest conditional deviation.
constexpr double kStepLogS = 0.1;
constexpr double kReachY = 9;           // P(|Y| > 9) = 2e-19.
constexpr double kNegligible = 1e-18;   // Of a sum so far.
constexpr double kBeyondDoubles = 39;   // The normal tail is below the smallest double.
constexpr double kLogNegligible = -46;  // exp(-46) = 1e-20.

/// MaxTail with s = 1.
class NormalMaximum {
 public:
  explicit NormalMaximum(const ManyToOne& family) : two_sided_(family.two_sided) {
    std::map<double, int> counts;
    for (const double loading : family.loadings) ++counts[loading];
    step_ = kStepY;
    for (const auto& [loading, count] : counts) {
      const double deviation = std::sqrt((1 - loading) * (1 + loading));
      FOOTING_CHECK(loading > 0 && deviation > 0);
      factors_.push_back({loading, deviation, static_cast<double>(count)});
      step_ = std::min(step_, kStepY * deviation);
    }
    greatest_loading_ = counts.rbegin()->first;
  }

  double Tail(double x) const {
    if (x > kBeyondDoubles) return 0;
    if (two_sided_ && x <= 0) return 1;
    if (x < -kBeyondDoubles) return 1;
    // Far out all weight is near y = l x.
    const double high = kReachY + greatest_loading_ * std::max(0.0, x);
    const int last = static_cast<int>(high / step_) + 1;
    // Two-sided, the integrand is even in y.
    const int first = two_sided_ ? 0 : -static_cast<int>(kReachY / step_) - 1;
    double sum = 0;
    for (int i = first; i <= last; ++i) {
      const double y = i * step_;
      const double share = two_sided_ && i > 0 ? 2 : 1;
      sum += share * std::exp(-y * y / 2) * Any(y, x);
    }
    return std::min(1.0, sum * step_ / std::sqrt(2 * std::numbers::pi));
  }

 private:
  struct Factor {
    double loading, deviation, count;
  };

  /// P(any Z_i >= x | Y = y), as 1 - product(1 - q_i) without cancellation.
  double Any(double y, double x) const {
    double log_none = 0;
    for (const Factor& factor : factors_) {
      double q = NormalTail((x - factor.loading * y) / factor.deviation);
      if (two_sided_) q += NormalTail((x + factor.loading * y) / factor.deviation);
      log_none += factor.count * std::log1p(-std::min(1.0, q));
    }
    return -std::expm1(log_none);
  }

  std::vector<Factor> factors_;
  double greatest_loading_ = 0;
  double step_ = 0;
  bool two_sided_;
};

}  // namespace

double MaxTail(const ManyToOne& family, double t) {
  FOOTING_CHECK(!family.loadings.empty() && family.degrees > 0 && !std::isnan(t));
  const NormalMaximum maximum(family);
  const double nu = family.degrees;
  if (std::isinf(nu)) return maximum.Tail(t);
  if (t == 0) return maximum.Tail(0);
  // With u = log s the density of s is proportional to exp(nu (u - e^(2u) / 2)); its constant
  // comes out of the same sum.
  const double step = std::min(kStepLogS, 0.4 / std::sqrt(2 * nu));
  const auto log_density = [nu](double u) { return nu * (u - std::expm1(2 * u) / 2); };
  int i = 1;
  while (log_density(i * step) > kLogNegligible) ++i;
  double norm = 0, sum = 0;
  for (;; --i) {
    const double u = i * step;
    const double density = std::exp(log_density(u));
    norm += density;
    sum += density * maximum.Tail(t * std::exp(u));
    if (u < 0 && density <= kNegligible * std::min(norm, sum)) break;
  }
  return std::min(1.0, sum / norm);
}

double MaxQuantile(const ManyToOne& family, double tail) {
  FOOTING_CHECK(tail > 0 && tail < 0.5);
  // Nearly a straight line where tails are heavy.
  const auto excess = [&](double log_t) {
    return std::log(MaxTail(family, std::exp(log_t)) / tail);
  };
  double low = 0, high = 1;
  while (excess(low) < 0) low -= 2;
  while (excess(high) > 0) high += 1;
  return std::exp(FindRoot(excess, low, high));
}

}  // namespace footing::statistics
