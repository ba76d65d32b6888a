#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/pose_run/insole_run.h"
#include "daemon/simulation/reconstruction/models.h"

namespace footing::eval {

/// Runs the reconstruction over somebody who walks in insoles, from the T-pose's end on, and
/// evaluates it root-relative; how far the root is off in W is beside it.
Result<nlohmann::ordered_json> ScoreInsoles(const pose_run::InsoleRun& run,
                                            const reconstruction::Models& models,
                                            const reconstruction::Options& options);

}  // namespace footing::eval
