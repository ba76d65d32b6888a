#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/model/model.h"
#include "daemon/offline/learning/ridge.h"
#include "daemon/simulation/reconstruction/features.h"

namespace footing::learning {

/// What a pose regression is trained with: a column a frame.
struct PoseExamples {
  std::vector<reconstruction::Features::Values> features;
  /// The root from the estimated centre of mass in parts of the root's height, then the angles.
  std::vector<Eigen::VectorXd> poses;
  std::vector<int> folds;  ///< Frames of one fold are predicted without it; 0 to kFolds - 1.
};
inline constexpr int kFolds = 5;

inline constexpr RandomWaves kPoseWaves{.count = 500};

struct FittedPoseRegression {
  reconstruction::PoseRegression regression;
  Eigen::MatrixXd rest_components;  ///< Rows; principal axes of the errors, scaled.
  Eigen::VectorXd rest_variances;
  double ridge = 0;   ///< Chosen: the best on frames that were left out,
  double error = 0;   ///< and its root mean square there, scaled,
  double spread = 0;  ///< beside that of the poses themselves.
};

/// Ridge regression (Hoerl & Kennard 1970) on the features and random waves of them, its penalty
/// chosen by leaving out folds, and the errors that it makes on what was left out. `scale`: by
/// which an entry of a pose counts.
FittedPoseRegression FitPoseRegression(const PoseExamples& examples, const Eigen::VectorXd& scale,
                                       const RandomWaves& waves = kPoseWaves);

void AppendTensors(const FittedPoseRegression& fitted, model::Model& model);

}  // namespace footing::learning
