#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/pose/targets.h"

/// The pose solver: hands, feet, centre of mass and momentum in, a full-body pose out (Ha, Bai and
/// Liu 2011, section 6, and what goes beyond it: docs/pose.md).
///
/// | paper            | here           | unit, frame                        |
/// |------------------|----------------|------------------------------------|
/// | q                | q              | m and rad, common/body             |
/// | P, by c          | com_W_m        | m, W                               |
/// | L                | angular_W      | kg m^2/s about the centre of mass  |
/// | G                | points         | m, W                               |
/// | principal compon.| PoseBasis      | q = mean + modes a                 |
namespace footing::pose {

/// Principal components of poses, in the order of their variance.
struct PoseBasis {
  Eigen::VectorXd mean;     ///< A pose.
  Eigen::MatrixXd modes;    ///< A column a component; q = mean + modes a.
  Eigen::MatrixXd inverse;  ///< a = inverse (q - mean), for poses of the space.
  Eigen::VectorXd sd;       ///< Standard deviation of each coefficient.

  int dof() const { return static_cast<int>(mean.size()); }
  int size() const { return static_cast<int>(sd.size()); }
};

/// Options of a basis of poses.
struct BasisOptions {
  /// A metre of the root counts as so many radians.
  double translation_weight = 2.5;
  /// As many components as explain this share of the variance; 1: all that vary at all.
  double variance_share = 1;
};

/// Principal component analysis of poses, a column each. At least two poses.
PoseBasis FitBasis(const Eigen::Ref<const Eigen::MatrixXd>& poses, const BasisOptions& options);

/// The same poses of a person whose root is so many times as high: angles stay.
PoseBasis Resized(PoseBasis basis, double scale);
/// The components that hold this share of the variance.
PoseBasis Leading(PoseBasis basis, double share);
/// The same with more variance along this direction, by its square.
PoseBasis Widened(const PoseBasis& basis, const Eigen::VectorXd& direction);
/// No basis: every degree of freedom for itself, with its own spread.
PoseBasis Unconnected(const PoseBasis& basis);

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

/// Options of the Gauss-Newton solver.
struct GaussNewtonOptions {
  int iterations = 3;
  int first_iterations = 30;  ///< For the first frame, which starts at the prior's mean.
  /// Weight of the prior over the coefficients, and of staying near the last frame's: the term's
  /// standard deviation is that of the coefficient over the weight. Not both 0.
  double prior_weight = 1;
  double smooth_weight = 2;
  double frame_s = 1.0 / 60;
};

/// Minimises equation (6) over all coefficients of a basis at once, each term divided by its
/// standard deviation, with a Gaussian prior over the coefficients: the most likely pose. A step
/// that makes it worse is taken back and tried again shorter (Levenberg 1944). A fast motion can
/// leave the last frame's pose next to another minimum, such as a pelvis upside down; a frame that
/// the targets contradict is therefore solved from the likely pose as well.
///
/// Nothing allocates after the constructor.
class GaussNewton {
 public:
  /// `body` and `basis` must outlive it and have equal degrees of freedom.
  GaussNewton(const body::Body& body, const PoseBasis& basis, const GaussNewtonOptions& options);

  /// Solves one frame; `likely_q` is the prior's mean given what is measured, the basis' own mean
  /// without. The first frame starts there, each later one at the last, moved as the mean has
  /// moved.
  void Solve(const PoseTargets& targets, const Eigen::VectorXd& likely_q);
  void Solve(const PoseTargets& targets) { Solve(targets, basis_->mean); }
  /// The next frame is a first one.
  void Reset() { started_ = false; }
  /// The next frame goes on from this pose.
  void ContinueFrom(const Eigen::VectorXd& q);

  const Eigen::VectorXd& q() const { return q_; }
  /// Where q() has the joints, once a frame is solved.
  const body::Kinematics& at() const { return terms_.at(); }
  /// Standard deviation of a joint's place at the last solution, along one axis (root mean square
  /// of the three), m: what the linearised terms leave open.
  double JointSd(int joint);
  /// The same of the COM, along each axis, m.
  Eigen::Vector3d ComSd();
  /// The same of the turn of a joint's frame against that of `above`, one of its ancestors (-1: W):
  /// variances, rad^2, of the rows of `to_angles` times the angular velocity in W.
  Eigen::Vector3d TurnVariances(int joint, int above, const Eigen::Matrix3d& to_angles);
  /// From now on until the next frame, deviations are those with this weight of the prior.
  void Weigh(double prior_weight) { update_.Factorise(prior_weight); }

 private:
  void Start(const Eigen::VectorXd& likely_q);
  void Measure(const PoseTargets& targets);
  /// The terms' derivatives where Measure was called last.
  void Differentiate(const PoseTargets& targets);
  /// Equation (6) where Measure was called last, but for what is equal everywhere.
  double Cost();
  void TakeStep(double damping);
  /// Steps from q_, which becomes the best of them. Returns its cost.
  double Descend(const PoseTargets& targets, int iterations);
  /// The standard deviations about q_, without damping.
  void Linearise(const PoseTargets& targets);
  /// Leaves a local minimum that is much worse than the one next to the likely pose.
  void DescendFromLikely(const PoseTargets& targets, const Eigen::VectorXd& likely_q);

  const PoseBasis* basis_;
  GaussNewtonOptions options_;
  bool started_ = false;
  bool mean_known_ = false;
  double prior_ = 0, smooth_ = 0;  ///< Weights of this frame, squared.
  MeasuredTerms terms_;
  PoseUpdate update_;
  Eigen::MatrixXd whitening_;  ///< From q - mean to coefficients over their deviations.
  Eigen::VectorXd q_, q_before_, q_best_, q_last_, mean_before_;
  Eigen::VectorXd centre_;    ///< Where mean and smoothness alone would have q.
  Eigen::VectorXd offset_q_;  ///< Offset of q from the centre or the mean, or a part of that.
  Eigen::VectorXd whitened_;
};

/// Options of the paper's solver, a Fibonacci search along each component.
struct FibonacciOptions {
  /// For equation (6), a component: 1/1597 of the interval is found. Steps of 1/34 (8 evaluations)
  /// are changes of momentum that no body has, and the term of L then held the pose back.
  int evaluations = 16;
  int sweeps = 1;
  int first_sweeps = 6;  ///< For the first frame, each over the whole range.
  /// A later frame searches so many standard deviations to each side of the last coefficient.
  double span = 0.3;
  /// No coefficient is searched further from 0, in its standard deviations: 99 of 100 poses are
  /// within. Where twice as much was allowed, coefficients that little holds wandered to where no
  /// pose is and stayed there, since each search begins from the last (docs/evaluation/pose.md).
  double reach = 2.5;
  /// A later frame begins with its coefficients moved on by this share of their last change (at 60
  /// Hz): the components that are not searched yet then have the momentum that they had. From rest
  /// the first component alone would take on that of the whole body.
  double carry = 0.6;
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
  /// Coefficients and pose that the search of a frame begins with.
  void Begin();
  /// Equation (6) with coefficient `component` at `value`, the others as they are.
  double CostAt(const PoseTargets& targets, int component, double value);
  void Search(const PoseTargets& targets, int component, double lower, double upper);

  const body::Body* body_;
  const PoseBasis* basis_;
  FibonacciOptions options_;
  bool started_ = false;
  double cost_ = 0;
  Eigen::VectorXd a_, a_before_, q_, q_before_, rate_, without_;
  body::Kinematics at_;
  body::JointVelocities velocities_;
};

}  // namespace footing::pose
