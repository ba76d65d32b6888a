#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/model/model.h"
#include "common/virtual/motion/motion.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

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
  Eigen::VectorXd mean, scale;  ///< Input scaling: (x - mean) scale, cut at +-4.
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

/// Cues that a pose is predicted from: hands and feet alone, or with the momentum too.
enum class PoseCues { kPosture, kMomentum };

/// Training data of a pose regression: a column a frame.
struct PoseExamples {
  std::vector<reconstruction::Features::Values> features;
  /// The root from the estimated centre of mass in parts of the root's height, then the angles.
  std::vector<Eigen::VectorXd> poses;
  std::vector<int> folds;  ///< Frames of one fold are predicted without it; from 0 on.
  /// Person of each frame: all people count alike, however long each was recorded. Frames of
  /// kOwn count once each.
  std::vector<int> people;
  static constexpr int kOwn = -1;

  /// The frame that `made` has just reconstructed, in truth at the pose `q`, whose angles are taken
  /// as those nearest to 0 that mean the same.
  void Add(const reconstruction::Reconstruction& made, PoseCues cues, const Eigen::VectorXd& q,
           int fold, int person = kOwn);
  void Append(const PoseExamples& other);
};
inline constexpr int kFolds = 5;  ///< Pieces of time, where there are too few people.

inline constexpr RandomWaves kPoseWaves{.count = 500};

/// A pose regression with the principal axes of its errors.
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

/// Training data of an arm regression, both arms as left ones.
struct ArmExamples {
  std::vector<arms::ArmFeatures::Values> features;
  std::vector<arms::Directions> directions;
  std::vector<int> folds;  ///< 0 to fold_count - 1.
  int fold_count = 0;      ///< At least two.
};

/// An arm regression with its ridge and errors.
struct FittedArm {
  arms::ArmModel model;
  double ridge = 0, error = 0, spread = 0;  ///< As of RidgeFit.
};

/// The covariance is that of the errors on the folds that were left out.
FittedArm FitArm(const ArmExamples& examples);

void AppendTensors(const arms::ArmModel& fitted, model::Model& model);

/// Columns to mean 0 and standard deviation 1. A constant column becomes 0.
struct Scaling {
  Eigen::RowVectorXd mean, scale;  ///< scaled = (value - mean) scale

  static Scaling Of(const Eigen::MatrixXd& values);
  /// Leaves every value as it is.
  static Scaling None(Eigen::Index columns);

  Eigen::MatrixXd Apply(const Eigen::MatrixXd& values) const;
};

std::vector<float> ToFloats(const Eigen::MatrixXd& values);  ///< Column by column.

/// Principal components of poses (pose paper, section 6): pose = mean + sum of a_k component_k over
/// scale, entry by entry. All components are kept, greatest variance first: those of one person
/// that are cut off are what another person's poses are missing.
struct PoseBasis {
  std::vector<std::string> dofs;  ///< Names of the pose's entries.
  Eigen::VectorXd mean;           ///< m and rad.
  Eigen::VectorXd scale;          ///< Weight of an entry; a metre is as much as 2.5 rad.
  Eigen::MatrixXd components;     ///< Rows of length 1, at right angles.
  Eigen::VectorXd variances;  ///< Variance of each component's a, divided by the number of poses.

  /// Components that hold the part `fraction` of the variance.
  int ComponentsFor(double fraction) const;
};

/// Basis of poses in columns: aligned motions (time_alignment.h) of one skeleton layout. The sign
/// of a component is such that its greatest entry is positive.
PoseBasis MakeBasis(const Eigen::MatrixXd& poses, std::vector<std::string> dofs);

/// Appends mean, scale, components and variances, labelled with the dofs.
void AppendTensors(const PoseBasis& basis, model::Model& model);

}  // namespace footing::learning
