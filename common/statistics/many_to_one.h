#pragma once

#include <limits>
#include <vector>

namespace footing::statistics {

/// The distribution of the greatest of several statistics that share a control.
///
///   | symbol | name here | meaning                                                   |
///   | k      |           | number of treatments                                      |
///   | l_i    | loadings  | correlation of T_i and T_j is l_i l_j; each l_i in (0, 1) |
///   | nu     | degrees   | degrees of freedom of the common s; infinite: s = 1       |
///
/// T_i = Z_i / s with Z_i = l_i Y + sqrt(1 - l_i^2) E_i, where Y and the E_i are independent
/// standard normal and s^2 is a chi-square variable over nu. Given s and Y the T_i are
/// independent, so the integral over k dimensions becomes one over two, for any k.
struct ManyToOne {
  std::vector<double> loadings;
  double degrees = std::numeric_limits<double>::infinity();
  bool two_sided = true;
};

/// P(max |T_i| >= t) if two-sided, otherwise P(max T_i >= t). The absolute error is below 1e-13;
/// small tails keep 10 digits. `t` may be infinite.
double MaxTail(const ManyToOne& family, double t);

/// The t with MaxTail(family, t) = `tail`, which is in (0, 0.5).
double MaxQuantile(const ManyToOne& family, double tail);

}  // namespace footing::statistics
