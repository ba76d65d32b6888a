#pragma once

#include <Eigen/Core>
#include <array>
#include <nlohmann/json.hpp>

#include "common/stream/hands.h"
#include "daemon/offline/analysis/pose_metrics.h"

namespace footing::eval {

/// Where a way has the joints of a skeleton, by body::IndexOf.
using JointPlaces = std::array<Eigen::Vector3d, stream::kBodyJoints>;

/// Errors of one way, cm: of hips and knees while the person squats, of any joint while the camera
/// infers it, and of those that it sees.
class FusedScore {
 public:
  void Add(const JointPlaces& truth, const JointPlaces& places,
           const std::array<bool, stream::kBodyJoints>& hidden, bool squats);
  double hip_cm() const { return hips_.mean(); }
  double knee_cm() const { return knees_.mean(); }
  double hidden_cm() const { return hidden_.mean(); }
  nlohmann::ordered_json Json() const;

 private:
  /// Why the knee of one side is off.
  void AddKnee(const JointPlaces& truth, const JointPlaces& places, std::size_t side);

  Spread hips_, knees_, hidden_, arms_, legs_, seen_, seen_arms_;
  Spread hip_heights_, feet_, turns_, unturned_;  ///< While the person squats.
};

}  // namespace footing::eval
