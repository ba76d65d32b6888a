#pragma once

#include "common/result/result.h"
#include "daemon/simulation/reconstruction/models.h"
#include "daemon/simulation/service/config.h"

namespace footing::simulation {

inline constexpr const char* kBasisFile = "basis.fmodel";
inline constexpr const char* kComFile = "com.fmodel";

/// The models of the pose engine, from the data folder: the basis, and in the paper's mode the
/// networks of the horizontal COM. One that is missing is an error that names it: nothing else
/// takes its place.
Result<reconstruction::Models> LoadPoseModels(const Config& config);

}  // namespace footing::simulation
