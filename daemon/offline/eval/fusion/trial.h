#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "common/result/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/options.h"

namespace footing::eval {

struct FusionOptions {
  /// Below this part of its height in the T-pose the pelvis counts as in a squat: the camera loses
  /// the legs, and what it reports of hips and knees is inferred.
  double squat_share = 0.85;
  std::uint64_t seed = 1;  ///< Of the skeleton's errors.
  /// Weights of the prior over poses and of staying near the last pose, of (b) and (d).
  double prior_weight = 0.6;
  double smooth_weight = 1;
};

/// Hips and knees of a person who squats, against the truth, from (a) a camera's skeleton as it is,
/// (b) the same skeleton solved for the most likely pose, (c) boards and hands, as the engine does
/// today, and (d) every joint of the skeleton with its covariance, together with COM and feet by
/// the boards (pose paper, section 7.3); the fields of `footing-eval fusion`. The run has a
/// Kinect's hands. The skeleton's joints come without delay. `options.lag_s` is 0.
Result<nlohmann::ordered_json> RunFusionTrial(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              const FusionOptions& fusion);

}  // namespace footing::eval
