#pragma once

#include <vector>

#include "common/model/model.h"
#include "daemon/simulation/pose/arm_features.h"
#include "daemon/simulation/pose/arm_model.h"

namespace footing::learning {

/// What an arm regression is trained with, both arms as left ones.
struct ArmExamples {
  std::vector<arms::ArmFeatures::Values> features;
  std::vector<arms::Directions> directions;
  std::vector<int> folds;  ///< 0 to fold_count - 1.
  int fold_count = 0;      ///< At least two.
};

struct FittedArm {
  arms::ArmModel model;
  double ridge = 0, error = 0, spread = 0;  ///< As of RidgeFit.
};

/// The covariance is that of the errors on the folds that were left out.
FittedArm FitArm(const ArmExamples& examples);

void AppendTensors(const arms::ArmModel& fitted, model::Model& model);

}  // namespace footing::learning
