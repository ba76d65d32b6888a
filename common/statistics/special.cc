#include "common/statistics/special.h"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace footing::statistics {

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
