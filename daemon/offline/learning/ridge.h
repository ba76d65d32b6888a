#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace footing::learning {

/// Cosines of the scaled inputs in random directions, beside the inputs: random Fourier features of
/// a Gaussian kernel (Rahimi & Recht 2007).
struct RandomWaves {
  int count = 0;
  double kernel_width = 0.5;  ///< In parts of the root of the inputs' number.
  std::uint64_t seed = 1;
};

/// Ridge regression (Hoerl & Kennard 1970) whose penalty is chosen by leaving out folds.
struct RidgeFit {
  Eigen::VectorXd mean, scale;  ///< Of the inputs: (x - mean) scale, cut at +-4.
  Eigen::MatrixXd weights;      ///< outputs x inputs, on all examples.
  Eigen::VectorXd offset;
  Eigen::MatrixXd waves;  ///< waves x inputs: cos(waves x + phases), of scaled inputs.
  Eigen::VectorXd phases;
  Eigen::MatrixXd wave_weights;  ///< outputs x waves.
  Eigen::MatrixXd errors;  ///< Scaled, a column an example, each by weights that have not seen it.
  double ridge = 0;        ///< The penalty, a part of each input's variance,
  double error = 0;        ///< the root mean square of `errors`' columns,
  double spread = 0;       ///< beside that of the outputs about their mean.
};

/// A column of `x` and `y` an example; `folds`: 0 to fold_count - 1, which fold each is left out
/// with. `output_scale`: by which the outputs' errors count. `weights`: how often each example
/// counts, > 0; empty: once.
RidgeFit FitRidge(Eigen::MatrixXd x, Eigen::MatrixXd y, const std::vector<int>& folds,
                  int fold_count, const Eigen::VectorXd& output_scale,
                  const RandomWaves& waves = {}, const Eigen::VectorXd& weights = {});

}  // namespace footing::learning
