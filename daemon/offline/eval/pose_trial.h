#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// What is given to the reconstruction instead of its own estimates.
struct Oracle {
  bool com = false, momentum = false, feet = false;
};

/// Runs one reconstruction over a run and evaluates all its outputs, from
/// run.judged_from on.
Result<nlohmann::ordered_json> RunPoseTrial(const pose_run::PoseRun& run,
                                            const reconstruction::Models& models,
                                            const reconstruction::Options& options,
                                            const Oracle& oracle);

}  // namespace footing::eval
