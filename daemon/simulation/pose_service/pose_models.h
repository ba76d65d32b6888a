#pragma once

#include <string>

#include "common/base/result.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::pose_service {

inline constexpr const char* kPoseFile = "pose.fmodel";
inline constexpr const char* kComFile = "com.fmodel";
inline constexpr const char* kArmFile = "arm.fmodel";

/// The models of the pose engine, from `data_folder` (empty: the installed one): the prior of
/// poses, and in the paper's mode the networks of the horizontal COM. One that is missing is an
/// error that names it: nothing else takes its place. Only the arms' model may be missing; Wiimotes
/// are not followed then, and said so.
Result<reconstruction::Models> LoadPoseModels(const std::string& data_folder,
                                              reconstruction::Mode mode);

}  // namespace footing::pose_service
