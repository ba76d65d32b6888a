#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/model/model.h"
#include "common/base/result.h"
#include "daemon/simulation/pose/arm_model.h"
#include "daemon/simulation/cascade/network.h"
#include "daemon/simulation/pose/basis.h"
#include "daemon/simulation/reconstruction/features.h"

namespace footing::reconstruction {

/// A model with the name of the file that it comes from.
struct NamedModel {
  std::string origin;
  model::Model model;
};

/// What the names of the tensors begin with that are of hands and feet alone.
inline constexpr const char* kPosturePrefix = "posture.";

/// The pose that some features make likely, and what is left of it: components of the regression's
/// errors.
struct LikelyPoses {
  PoseRegression regression;
  pose::PoseBasis rest;  ///< About the mean of all poses.

  bool empty() const { return regression.empty(); }
};

/// What has been learned of how people move (docs/models.md).
struct Models {
  pose::PoseBasis basis;
  double root_height_m = 0;  ///< Of the basis' people, in the T-pose; 0: unknown.
  /// The pose that the features make likely, and what is left of it: components of the regression's
  /// errors, about the mean of `basis`. Where the model has them (kind "pose").
  PoseRegression regression;
  pose::PoseBasis rest;
  /// The same by hands and feet alone (WithoutLoads), where the model has it.
  LikelyPoses posture;
  std::vector<std::string> dofs;  ///< Of the basis: the layout of the bodies that it fits.
  std::string origin;             ///< File of the basis.
  /// Next C_x and C_y (section 4.2), where there are such networks.
  std::optional<std::array<cascade::CascadeNetwork, 2>> horizontal;
  /// For hands that hold a Wiimote, where there is one.
  std::optional<arms::ArmModel> arm;
};

/// At most one model of each kind: "basis" or "pose" is necessary, "com" and "arm" are not. Errors
/// name the file.
Result<Models> MakeModels(const std::vector<NamedModel>& models);

}  // namespace footing::reconstruction
