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
/// measurements than coefficients, so steps are solved for among the measurements (Woodbury 1950),
/// and among poses instead of coefficients: a measurement depends on the few degrees of freedom
/// that move its joint, but on every coefficient.
///
/// Nothing allocates after the constructor.
class GaussNewton {
 public:
  /// `body` and `basis` must outlive it and have equal degrees of freedom.
  GaussNewton(const body::Body& body, const PoseBasis& basis, const GaussNewtonOptions& options);

  /// Solves one frame; `likely_q` is the prior's mean given what is measured, the basis' own mean
  /// without. The first frame begins there, each later one at the last, moved as the mean has
  /// moved.
  void Solve(const PoseTargets& targets, const Eigen::VectorXd& likely_q);
  void Solve(const PoseTargets& targets) { Solve(targets, basis_->mean); }
  /// The next frame begins anew.
  void Reset() { started_ = false; }
  /// The next frame goes on from this pose.
  void ContinueFrom(const Eigen::VectorXd& q);

  const Eigen::VectorXd& q() const { return q_; }
  /// Where q() has the joints, once a frame is solved.
  const body::Kinematics& at() const { return at_; }
  /// Standard deviation of a joint's place at the last solution, along one axis (root mean square
  /// of the three), m: what the linearised terms leave open.
  double JointSd(int joint);
  /// The same of C, along each axis, m.
  Eigen::Vector3d ComSd();

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Dofs = std::vector<int>;
  /// Three residuals' derivatives by the degrees of freedom `dofs`; columns of others mean nothing.
  struct Block {
    Eigen::Matrix<double, 3, Eigen::Dynamic> by_q;
    const Dofs* dofs = nullptr;
  };

  void Begin(const Eigen::VectorXd& likely_q);
  /// Kinematics and residuals of q_.
  void Measure(const PoseTargets& targets);
  /// Blocks of the residuals that were measured, and what the prior makes of them.
  void Differentiate(const PoseTargets& targets);
  void PointBlock(const PointTarget& point, Block& out);
  /// Equation (6) where Measure was called last, but for what is equal everywhere.
  double Cost();
  void TakeStep(double damping);
  void Factorise(double damping);
  /// What the terms leave open of three lengths that depend on q as the block says.
  Eigen::Vector3d OpenVariances(const Block& block);
  bool Angular(const PoseTargets& targets) const { return targets.has_angular && started_; }
  Block& block(int row) { return blocks_[static_cast<std::size_t>(row / 3)]; }

  const body::Body* body_;
  const PoseBasis* basis_;
  GaussNewtonOptions options_;
  bool started_ = false;
  bool mean_known_ = false;
  double prior_ = 0, smooth_ = 0;  ///< Weights of this frame, squared.
  double held_ = 1;                ///< Their sum, and the damping's.
  /// Of q by the basis, over the weights' sum; rows are filled up with zeros to whole strips.
  Rows covariance_;
  Eigen::MatrixXd whitening_;   ///< From q - mean to coefficients over their deviations.
  std::vector<Dofs> moved_by_;  ///< Degrees of freedom that move each joint.
  Dofs all_;
  Eigen::VectorXd q_, q_before_, q_best_, step_q_, mean_, mean_before_;
  Eigen::VectorXd centre_;  ///< Where mean and smoothness alone would have q.
  Eigen::VectorXd whitened_;
  std::vector<Block> blocks_;
  Block open_;   ///< Of OpenVariances.
  Rows reach_;   ///< covariance_ times the blocks' transposes: dof x rows.
  Rows gram_;    ///< The blocks times that; its lower triangle.
  Rows square_;  ///< 1 + gram_ / held_; its lower triangle becomes its Cholesky factor.
  Rows open_reach_, open_across_;
  Eigen::VectorXd residuals_, pull_;
  int row_count_ = 0;
  Eigen::Vector3d com_W_m_;
  body::Kinematics at_;
  body::CompositeMasses room_;
  body::CentroidalMatrix centroidal_;
};

}  // namespace footing::pose
