#pragma once

#include <vector>

#include "common/statistics/rate.h"

namespace footing::statistics {

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
  /// Of the greatest likelihood: 0 for a group without events.
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
