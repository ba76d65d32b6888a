#pragma once

#include <Eigen/Core>

#include "daemon/offline/learning/quickprop.h"

namespace footing::learning {

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
