#pragma once

#include <Eigen/Core>
#include <string>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/simulation/pose/arm_features.h"
#include "daemon/simulation/pose/arm_geometry.h"

namespace footing::arms {

/// Of ArmDirections: upper, hinge, forearm.
inline constexpr int kDirections = 9;
using Directions = Eigen::Matrix<double, kDirections, 1>;

Directions Stacked(const ArmDirections& arm);
/// The same as unit vectors; those of a T-pose where the numbers have no direction.
ArmDirections Of(const Directions& stacked);
/// A right arm as a left one, and back: the mirror image at the plane y = 0.
ArmDirections Mirrored(const ArmDirections& arm);

/// From features to how an arm is held, learned (docs/models.md), and how far off that is.
struct ArmModel {
  ArmFeatures::Values mean, scale;  ///< Of the features: (f - mean) scale, cut at +-4.
  Eigen::MatrixXd weights;          ///< kDirections x ArmFeatures::kCount.
  Directions offset;
  /// Of the errors on persons that were left out, in the left arm's frame.
  Eigen::Matrix<double, kDirections, kDirections> covariance;

  /// Writes the scaled features to `features`. Where nothing is known of the other hand, what it
  /// says is what it said in the mean.
  Directions Predict(ArmFeatures::Values& features, bool other_known = true) const;
};

/// InvalidData where a tensor is missing or of another shape; `origin` names the file.
Result<ArmModel> MakeArmModel(const model::Model& model, const std::string& origin);

/// How an arm is held, and one standard deviation along W's axes (no unit: parts of a length).
struct ArmEstimate {
  bool valid = false;
  ArmDirections directions;
  Eigen::Vector3d upper_sd = Eigen::Vector3d::Ones(), hinge_sd = Eigen::Vector3d::Ones(),
                  forearm_sd = Eigen::Vector3d::Ones();
};

}  // namespace footing::arms
