#pragma once

#include "common/result/result.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/serving/config.h"

namespace footing::pose_service {

inline constexpr const char* kPoseFile = "pose.fmodel";
inline constexpr const char* kComFile = "com.fmodel";
inline constexpr const char* kArmFile = "arm.fmodel";

/// The models of the pose engine, from the data folder: the prior of poses, and in the paper's mode
/// the networks of the horizontal COM. One that is missing is an error that names it: nothing else
/// takes its place. Only the arms' model may be missing; Wiimotes are not followed then, and said
/// so.
Result<reconstruction::Models> LoadPoseModels(const serving::Config& config);

}  // namespace footing::pose_service
