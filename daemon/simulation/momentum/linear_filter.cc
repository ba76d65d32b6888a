#include "daemon/simulation/momentum/linear_filter.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::momentum {

MixtureMoments TimesMixture(const Moments& prior, const std::array<Component, 2>& mixture) {
  std::array<double, 2> log_weight{};
  std::array<Moments, 2> product{};
  for (std::size_t i = 0; i < 2; ++i) {
    const Component& part = mixture[i];
    const double variance = part.spread * part.spread, s = prior.variance + variance;
    const double difference = part.mean - prior.mean;
    log_weight[i] = std::log(std::max(part.share, 1e-12)) - 0.5 * std::log(s) -
                    0.5 * difference * difference / s;
    product[i] = {prior.mean + prior.variance / s * difference, prior.variance * variance / s};
  }
  const double greater = std::max(log_weight[0], log_weight[1]);
  double first = std::exp(log_weight[0] - greater), second = std::exp(log_weight[1] - greater);
  const double sum = first + second;
  first /= sum;
  second /= sum;
  const double apart = product[0].mean - product[1].mean;
  return {
      {first * product[0].mean + second * product[1].mean,
       first * product[0].variance + second * product[1].variance + first * second * apart * apart},
      greater + std::log(sum)};
}

Moments Below(const Moments& prior, double limit) {
  const double spread = std::sqrt(prior.variance);
  const double a = (limit - prior.mean) / spread;
  if (a > 6) return prior;
  if (a < -6) {  // The tail is an exponential of rate -a: its moments, without 0 / 0.
    const double mean = limit - spread / -a;
    return {mean, prior.variance / (a * a)};
  }
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2 * kPi);
  const double ratio = density / (0.5 * std::erfc(-a / std::sqrt(2.0)));
  const double variance = prior.variance * (1 - a * ratio - ratio * ratio);
  return {prior.mean - spread * ratio, std::max(variance, 1e-3 * prior.variance)};
}

}  // namespace footing::momentum
