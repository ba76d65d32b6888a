#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// Writes plots like the paper's Figures 5 to 8 into a folder, which is made where it is missing,
/// each over the part of the motion that has most of what it shows: vertical COM where the COM
/// rises and falls most, horizontal COM where it leans furthest, the shoulder's and the elbow's
/// angles where an arm swings most, and stick figures of the deepest crouch (run/crouch.h),
/// whose title says where there is none. Files of before are overwritten. Returns the names.
Result<std::vector<std::string>> WriteFigures(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              const std::string& folder);

}  // namespace footing::eval
