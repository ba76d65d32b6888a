#pragma once

#include <Eigen/Core>

#include "common/virtual/devices/noise.h"

namespace footing::learning {

/// Quickprop (Fahlman 1988): for every weight a parabola through the last two slopes, whose lowest
/// point is the next step.
struct QuickpropOptions {
  double epsilon = 1;  ///< Part of the slope that is gone down besides, or instead at a start.
  double growth = 2;   ///< mu: a step is at most this many times the last one.
  double decay = 0;    ///< Decay of the weights, added to the slope.
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

/// The hidden unit's s(x) = 1 / (1 + exp(-x)) - 1/2, and its derivative from its value:
/// s' = 1/4 - s^2.
Eigen::ArrayXXd Sigmoid(const Eigen::ArrayXXd& x);

/// Options of the candidates' training.
struct CandidateOptions {
  int pool = 8;
  int epochs_max = 200;
  int patience = 8;         ///< Epochs without a change of the best score, then it stops.
  double change = 0.03;     ///< Part of the score that counts as a change.
  double weight_range = 1;  ///< First weights are uniform within +-this.
  QuickpropOptions quickprop = {.epsilon = 2, .growth = 2, .decay = 0};
};

/// Inputs of candidates, and the errors they are to explain. Covariance is searched in single
/// precision, which is twice as fast; error reduction takes the difference of nearly equal numbers.
template <typename Scalar>
struct CandidateTask {
  using Matrix = Eigen::MatrixX<Scalar>;

  /// Fahlman & Lebiere's measure: `errors` centred and scaled.
  static CandidateTask Covariance(const Eigen::Ref<const Eigen::MatrixXd>& units,
                                  const Eigen::MatrixXd& errors);
  /// The measure for linear outputs by least squares: `basis` is orthonormal, spans `units`, and
  /// is at right angles to `errors`.
  static CandidateTask ErrorReduction(const Eigen::Ref<const Eigen::MatrixXd>& units,
                                      const Eigen::MatrixXd& errors,
                                      const Eigen::Ref<const Eigen::MatrixXd>& basis);

  Matrix units;   ///< Rows x (1, inputs, hidden units).
  Matrix basis;   ///< Rows x any number; none for covariance.
  Matrix errors;  ///< Rows x outputs.
};

/// How good each candidate c is, V_pc its value on row p, E_po the error of output o.
/// Covariance (1990, section 2): S = sum over o of |sum over p of V_pc (E_po - mean E_o)|.
///   Departure: E is divided by its root mean square and by the number of rows, so that neither
///   changes the step size.
/// Error reduction: S^2 is the part of the squared error that outputs solved again lose by the
/// unit:
///   S = |E' V_c| / (|E| |V_c less what the basis explains of it|). It follows a curve where
///   covariance, which grows with a unit's size, finds a step.
template <typename Scalar>
struct Scores {
  Eigen::MatrixX<Scalar> values;        ///< V, rows x candidates.
  Eigen::MatrixX<Scalar> rest;          ///< V less what the basis explains; empty for covariance.
  Eigen::MatrixX<Scalar> correlations;  ///< E' V, outputs x candidates.
  Eigen::RowVectorX<Scalar> sizes;      ///< |rest|, a little more where it is tiny.
  Eigen::RowVectorX<Scalar> scores;     ///< S of each candidate.
};

/// `weights`: columns of `units` x candidates.
template <typename Scalar>
Scores<Scalar> Score(const CandidateTask<Scalar>& task, const Eigen::MatrixXd& weights);

/// dS / d weights, exact wherever no correlation is 0.
template <typename Scalar>
Eigen::MatrixXd ScoreGradient(const CandidateTask<Scalar>& task, const Scores<Scalar>& scores);

/// The candidate that won, trained.
struct NewUnit {
  Eigen::VectorXd weights;
  Eigen::VectorXd values;        ///< On the rows of `units`.
  Eigen::VectorXd correlations;  ///< E' V of it.
  int epochs = 0;
};

/// Trains a pool of candidates to the greatest score and returns the best.
template <typename Scalar>
NewUnit TrainCandidates(const CandidateTask<Scalar>& task, const CandidateOptions& options,
                        noise::Random& random);

/// Options of the training of sigmoid outputs.
struct OutputOptions {
  int epochs_max = 200;
  int patience = 8;
  double change = 0.01;  ///< Part of the error that counts as a change.
  QuickpropOptions quickprop = {.epsilon = 1, .growth = 2, .decay = 1e-4};
};

/// Sigmoid outputs, trained by Quickprop. The derivative gets 0.1 more (Fahlman 1988), so that an
/// output that is wrong with conviction can come back.
struct SigmoidOutputs {
  Eigen::MatrixXd weights;  ///< Columns of `units` x outputs.
  Eigen::MatrixXd values;   ///< Rows x outputs, within +-1/2.
  Eigen::MatrixXd errors;   ///< (value - target) (s' + 0.1): what candidates follow.

  /// Evaluates `weights` on `units`.
  void Evaluate(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets);

  /// Returns the epochs used. Stops early once every value is nearer to its target than `near`.
  int Train(const Eigen::MatrixXd& units, const Eigen::MatrixXd& targets, double near,
            const OutputOptions& options);

  /// The greatest |value - target|.
  double Worst(const Eigen::MatrixXd& targets) const;
};

}  // namespace footing::learning
