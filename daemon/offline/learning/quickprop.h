#pragma once

#include <Eigen/Core>

namespace footing::learning {

/// Quickprop (Fahlman 1988): for every weight a parabola through the last two slopes, whose lowest
/// point is the next step.
struct QuickpropOptions {
  double epsilon = 1;  ///< Part of the slope that is gone down besides, or instead at a start.
  double growth = 2;   ///< mu: a step is at most this many times the last one.
  double decay = 0;    ///< Of the weights, added to the slope.
};

/// State of one set of weights; goes down the slopes it is given.
class Quickprop {
 public:
  Quickprop(Eigen::Index rows, Eigen::Index columns, const QuickpropOptions& options);

  /// Moves `weights` by one step; `slopes` are the derivatives of what is to become least.
  void Step(const Eigen::MatrixXd& slopes, Eigen::MatrixXd& weights);

 private:
  QuickpropOptions options_;
  Eigen::MatrixXd last_steps_, last_slopes_;
};

}  // namespace footing::learning
