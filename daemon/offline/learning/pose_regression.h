#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/model/model.h"
#include "daemon/offline/learning/ridge.h"
#include "daemon/simulation/reconstruction/features.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::learning {

/// By what a pose is to be foreseen: hands and feet alone, or with the momentum too.
enum class PoseCues { kPosture, kMomentum };

/// What a pose regression is trained with: a column a frame.
struct PoseExamples {
  std::vector<reconstruction::Features::Values> features;
  /// The root from the estimated centre of mass in parts of the root's height, then the angles.
  std::vector<Eigen::VectorXd> poses;
  std::vector<int> folds;  ///< Frames of one fold are predicted without it; from 0 on.
  /// Whose frames they are: all people count alike, however long each was recorded. Frames of
  /// kOwn count once each.
  std::vector<int> people;
  static constexpr int kOwn = -1;

  /// The frame that `made` has just reconstructed, in truth at the pose `q`, whose angles are taken
  /// as those nearest to 0 that mean the same.
  void Add(const reconstruction::Reconstruction& made, PoseCues cues, const Eigen::VectorXd& q,
           int fold, int person = kOwn);
  void Append(const PoseExamples& other);
};
inline constexpr int kFolds = 5;  ///< Of pieces of time, where there are too few people.

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

/// Their names begin with `prefix`.
void AppendTensors(const FittedPoseRegression& fitted, model::Model& model,
                   const std::string& prefix = "");

}  // namespace footing::learning
