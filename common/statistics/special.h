#pragma once

#include <functional>

namespace footing::statistics {

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
