#pragma once

#include <Eigen/Core>

#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/measured_terms.h"

namespace footing::pose {

/// How measured terms move a pose of a Gaussian prior. There are fewer rows than coefficients, so
/// steps are solved for among the rows (Woodbury 1950), and with the covariance of poses instead of
/// coefficients: a row depends on the few degrees of freedom that move its joint, but on every
/// coefficient.
///
/// | symbol | here                                                                            |
/// |--------|---------------------------------------------------------------------------------|
/// | P      | covariance of q by the basis, over `weight`: of the prior, smoothness and damping |
/// | H, r   | MeasuredTerms: derivatives and residuals                                          |
/// | S      | 1 + H P H'                                                                        |
///
/// Sums run in a fixed order, so a frame has the same bits whatever the processor adds side by
/// side. Nothing allocates after the constructor.
class PoseUpdate {
 public:
  explicit PoseUpdate(const PoseBasis& basis);

  /// Takes H, at the derivatives of `terms`.
  void SetTerms(const MeasuredTerms& terms);
  /// The Cholesky factor of S for this weight.
  void Factorise(double weight);
  /// q - offset + P H' S^-1 (r + H offset), with `offset` from the prior's centre to q.
  void Correct(const MeasuredTerms& terms, const Eigen::VectorXd& offset, Eigen::VectorXd& q);
  /// Variances that the terms leave of three lengths that depend on q as the block says.
  Eigen::Vector3d OpenVariances(const JacobianBlock& block);

 private:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  int dof_ = 0;
  int row_count_ = 0;
  double weight_ = 1;
  Rows P_;     ///< Before it is divided by the weight; rows are padded with zeros to whole strips.
  Rows PHt_;   ///< P_ H': dof x rows.
  Rows HPHt_;  ///< Its lower triangle.
  Rows S_;     ///< Its lower triangle becomes its Cholesky factor.
  Rows open_PHt_, open_HPHt_;
  Eigen::VectorXd innovation_;
};

}  // namespace footing::pose
