#pragma once

#include <Eigen/Core>

#include "common/virtual/devices/random.h"
#include "daemon/offline/learning/quickprop.h"

namespace footing::learning {

/// The hidden unit's s(x) = 1 / (1 + exp(-x)) - 1/2, and its derivative from its value:
/// s' = 1/4 - s^2.
Eigen::ArrayXXd Sigmoid(const Eigen::ArrayXXd& x);

struct CandidateOptions {
  int pool = 8;
  int epochs_max = 200;
  int patience = 8;         ///< Epochs without a change of the best score, then it stops.
  double change = 0.03;     ///< Part of the score that counts as a change.
  double weight_range = 1;  ///< First weights are uniform within +-this.
  QuickpropOptions quickprop = {.epsilon = 2, .growth = 2, .decay = 0};
};

/// What candidates see, and what they are to explain. Covariance is searched in single precision,
/// which is twice as fast; error reduction takes the difference of nearly equal numbers.
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

}  // namespace footing::learning
