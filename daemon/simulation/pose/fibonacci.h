#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

struct FibonacciOptions {
  int evaluations = 8;  ///< Of equation (6) a component: 1/34 of the interval is found.
  int sweeps = 1;
  int first_sweeps = 6;  ///< Of the first frame, each over the whole range.
  /// A later frame searches so many standard deviations to each side of the last coefficient.
  double span = 0.3;
  /// No coefficient is searched further from 0, in its standard deviations: 95 of 100 poses are
  /// within. Where twice as much was allowed, coefficients that little holds wandered to where no
  /// pose is and stayed there, since each search begins from the last (docs/evaluation/pose.md).
  double reach = 2;
  double frame_s = 1.0 / 60;
};

/// The paper's solver (section 6): a one-dimensional Fibonacci search along each principal
/// component, in the order of importance, over equation (6). The paper does not say how its terms
/// of different units are weighed; here each is divided by its standard deviation.
///
/// Nothing allocates after the constructor.
class FibonacciSearch {
 public:
  /// `body` and `basis` must outlive it and have equal degrees of freedom.
  FibonacciSearch(const body::Body& body, const PoseBasis& basis, const FibonacciOptions& options);

  void Solve(const PoseTargets& targets);
  /// The next frame starts at the mean.
  void Reset() { started_ = false; }

  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& coefficients() const { return a_; }
  /// Equation (6) at the last solution.
  double cost() const { return cost_; }

 private:
  double Cost(const PoseTargets& targets);
  /// Equation (6) with coefficient `component` at `value`, the others as they are.
  double CostAt(const PoseTargets& targets, int component, double value);
  void Search(const PoseTargets& targets, int component, double lower, double upper);

  const body::Body* body_;
  const PoseBasis* basis_;
  FibonacciOptions options_;
  bool started_ = false;
  double cost_ = 0;
  Eigen::VectorXd a_, q_, q_before_, rate_, without_;
  body::Kinematics at_;
  body::JointVelocities velocities_;
};

}  // namespace footing::pose
