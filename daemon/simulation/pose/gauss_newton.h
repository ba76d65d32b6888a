#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "common/body/momentum.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

struct GaussNewtonOptions {
  int iterations = 3;
  int first_iterations = 30;  ///< Of the first frame, which begins at the prior's mean.
  /// Weight of the prior over the coefficients, and of staying near the last frame's: the term's
  /// standard deviation is that of the coefficient over the weight.
  double prior_weight = 1;
  double smooth_weight = 2;
  double frame_s = 1.0 / 60;
};

/// Minimises equation (6) over all coefficients of a basis at once, each term divided by its
/// standard deviation, with a Gaussian prior over the coefficients: the most likely pose. A step
/// that makes it worse is taken back and tried again shorter (Levenberg 1944).
///
/// Nothing allocates after the constructor.
class GaussNewton {
 public:
  /// `body` and `basis` must outlive it and have equal degrees of freedom.
  GaussNewton(const body::Body& body, const PoseBasis& basis, const GaussNewtonOptions& options);

  /// Solves one frame; `prior_mean` is the mean of the coefficients given what is measured, zero
  /// for that of the basis alone. The first frame begins there, each later one at the last, moved
  /// as the mean has moved.
  void Solve(const PoseTargets& targets, const Eigen::Ref<const Eigen::VectorXd>& prior_mean);
  void Solve(const PoseTargets& targets) { Solve(targets, no_mean_); }
  /// The next frame begins anew.
  void Reset() { started_ = false; }
  /// The next frame goes on from this pose.
  void ContinueFrom(const Eigen::VectorXd& q);

  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& coefficients() const { return a_; }
  /// Inverse of the coefficients' covariance at the solution; lower triangle.
  const Eigen::MatrixXd& information() const { return information_; }
  /// Standard deviation of a joint's place at the last solution, along one axis (root mean square
  /// of the three), m.
  double JointSd(int joint);

 private:
  void Linearise(const PoseTargets& targets);
  /// Equation (6) with the prior at a_, where Linearise was called last.
  double Cost(const Eigen::Ref<const Eigen::VectorXd>& prior_mean) const;
  void TakeStep(const Eigen::Ref<const Eigen::VectorXd>& prior_mean, double damping);
  void PlaceAt(const Eigen::VectorXd& coefficients);
  void AddRows(const Eigen::Vector3d& residual, const Eigen::Vector3d& sd);

  const body::Body* body_;
  const PoseBasis* basis_;
  GaussNewtonOptions options_;
  bool started_ = false;
  bool mean_known_ = false;
  double prior_ = 0, smooth_ = 0;  ///< Weights of this frame, squared.
  Eigen::VectorXd no_mean_, mean_before_, a_, a_before_, a_best_, q_, q_before_, step_q_, step_;
  Eigen::MatrixXd information_;
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian_;
  Eigen::MatrixXd rows_;  ///< Weighted rows in the coefficients, `row_count_` of them.
  Eigen::VectorXd residuals_;
  Eigen::MatrixXd spread_;  ///< Room for JointSd.
  int row_count_ = 0;
  body::Kinematics at_;
  body::CompositeMasses room_;
  body::CentroidalMatrix centroidal_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
};

}  // namespace footing::pose
