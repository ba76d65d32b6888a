#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "daemon/offline/learning/candidates.h"
#include "daemon/offline/learning/mlp.h"
#include "daemon/simulation/cascade/network.h"

namespace footing::learning {

/// Kinds of output units.
enum class Outputs {
  kLinear,   ///< Any targets; output weights by least squares.
  kSigmoid,  ///< Targets of +-1/2, as the classic problems have; by Quickprop.
};

/// Training objective of a candidate unit; see Scores.
enum class Objective { kCovariance, kErrorReduction };

/// Options of TrainCascade.
struct CascadeOptions {
  Outputs outputs = Outputs::kLinear;
  /// Objective for linear outputs; candidates for sigmoid ones always go by covariance.
  Objective objective = Objective::kErrorReduction;
  int hidden_max = 30;
  /// Validation may not go below it; at most hidden_max. A goal that is reached with fewer may.
  int hidden_min = 0;
  /// Stops at a mean squared error of training, in the targets' unit squared, at or below this.
  double mse_goal = 0;
  /// Sigmoid outputs: stops when every output is nearer to its target than this.
  double near = 0.4;
  /// With validation rows: hidden units in a row without an improvement of validation by the part
  /// `improvement`; then the network goes back to its best.
  int patience = 5;
  double improvement = 0.01;
  CandidateOptions candidates;
  OutputOptions output_training;
};

/// A trained network with its errors, mean squared, in the targets' unit squared.
struct CascadeResult {
  cascade::CascadeNetwork network;
  int hidden_units = 0;
  int epochs = 0;  ///< Passes over the data, of candidates and outputs.
  double train_mse = 0;
  double validation_mse = 0;  ///< Error of the float32 network; 0 without validation rows.
  bool goal_reached = false;  ///< mse_goal or near.
};

/// Cascade correlation (Fahlman & Lebiere 1990; pose paper, section 4.2): starts without hidden
/// units; then one unit at a time, the best of a pool trained to follow the error that is left,
/// whose weights are never changed again; then the outputs are trained again.
/// Departure: linear outputs are solved for, not gone down to. Nothing trains on `validation`
/// (which may be empty), but it chooses how many hidden units stay.
CascadeResult TrainCascade(const Examples& train, const Examples& validation,
                           const CascadeOptions& options, std::uint64_t seed);

/// Mean over rows and outputs of the squared error of a network, in the targets' unit squared.
double MeanSquaredError(const cascade::CascadeNetwork& network, const Examples& examples);

/// Linear outputs of least squared error over columns that come one at a time: modified
/// Gram-Schmidt, orthogonalised twice. What Quickprop on linear outputs goes towards, at once.
class LeastSquares {
 public:
  /// `targets`: rows x outputs. At most `columns_max` columns will come.
  LeastSquares(const Eigen::MatrixXd& targets, Eigen::Index columns_max);

  /// A column that the ones before it explain gets weight 0.
  void Add(const Eigen::VectorXd& column);

  /// Prediction less target: at right angles to every column so far.
  const Eigen::MatrixXd& errors() const { return errors_; }

  /// Orthonormal, as many columns as were added; a column that was left out is 0 here.
  auto basis() const { return basis_.leftCols(columns_); }

  /// Columns so far x outputs.
  Eigen::MatrixXd Weights() const;

 private:
  Eigen::MatrixXd basis_;     ///< Orthonormal, Q.
  Eigen::MatrixXd triangle_;  ///< R: columns = Q R; a 0 on the diagonal marks a column left out.
  Eigen::MatrixXd along_;     ///< Q' targets.
  Eigen::MatrixXd errors_;
  Eigen::Index columns_ = 0;
};

}  // namespace footing::learning
