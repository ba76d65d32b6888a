#pragma once

#include <Eigen/Core>
#include <vector>

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
  /// standard deviation is that of the coefficient over the weight. Not both 0.
  double prior_weight = 1;
  double smooth_weight = 2;
  double frame_s = 1.0 / 60;
};

/// Minimises equation (6) over all coefficients of a basis at once, each term divided by its
/// standard deviation, with a Gaussian prior over the coefficients: the most likely pose. A step
/// that makes it worse is taken back and tried again shorter (Levenberg 1944). There are fewer
/// measurements than coefficients, so steps are solved for among the measurements (Woodbury 1950).
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
  /// Standard deviation of a joint's place at the last solution, along one axis (root mean square
  /// of the three), m: what the linearised terms leave open.
  double JointSd(int joint);
  /// The same of C, along each axis, m; where C was a target.
  Eigen::Vector3d ComSd();

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void Begin(const Eigen::Ref<const Eigen::VectorXd>& prior_mean);
  /// Kinematics and residuals of q_.
  void Measure(const PoseTargets& targets);
  /// Rows of the residuals that were measured.
  void Differentiate(const PoseTargets& targets);
  void PointRows(const PointTarget& point, int row);
  /// Equation (6) with the prior at a_, where Measure was called last.
  double Cost(const Eigen::Ref<const Eigen::VectorXd>& prior_mean) const;
  void TakeStep(const Eigen::Ref<const Eigen::VectorXd>& prior_mean, double damping);
  void Factorise(double damping);
  /// What the terms leave open of three lengths whose rows in the coefficients joint_rows_ has.
  Eigen::Vector3d OpenVariances();
  void PlaceAt(const Eigen::VectorXd& coefficients);
  bool Angular(const PoseTargets& targets) const { return targets.has_angular && started_; }

  const body::Body* body_;
  const PoseBasis* basis_;
  GaussNewtonOptions options_;
  bool started_ = false;
  bool mean_known_ = false;
  double prior_ = 0, smooth_ = 0;           ///< Weights of this frame, squared.
  Rows modes_;                              ///< Of the basis, a row a degree of freedom together.
  std::vector<std::vector<int>> moved_by_;  ///< Degrees of freedom that move each joint.
  Eigen::VectorXd no_mean_, mean_before_, a_, a_before_, a_best_, q_, q_before_, step_q_;
  Eigen::VectorXd variances_, free_sd_, pull_;  ///< Of the coefficients.
  Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian_;
  Rows rows_;    ///< Weighted, in the coefficients, `row_count_` of them; then times free_sd_.
  Rows square_;  ///< 1 + rows rows'; its lower triangle becomes its Cholesky factor.
  Eigen::VectorXd residuals_, across_;
  Rows joint_rows_;
  Eigen::MatrixXd joint_across_;
  int row_count_ = 0;
  Eigen::Vector3d com_W_m_;
  body::Kinematics at_;
  body::CompositeMasses room_;
  body::CentroidalMatrix centroidal_;
};

}  // namespace footing::pose
