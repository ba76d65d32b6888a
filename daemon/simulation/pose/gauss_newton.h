#pragma once

#include <Eigen/Core>

#include "common/body/body.h"
#include "common/body/kinematics.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/pose/measured_terms.h"
#include "daemon/simulation/pose/pose_update.h"
#include "daemon/simulation/pose/targets.h"

namespace footing::pose {

struct GaussNewtonOptions {
  int iterations = 3;
  int first_iterations = 30;  ///< Of the first frame, which starts at the prior's mean.
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
  Eigen::VectorXd offset_q_;  ///< Of q from the centre or the mean, or a part of that.
  Eigen::VectorXd whitened_;
};

}  // namespace footing::pose
