#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// The paper's section 7.4 for every term, in both modes: all terms, without each of them, and in
/// paper mode without the networks of 4.2. Options are those of all runs but their mode and terms;
/// lag is the best mode's alone. A row each: {mode, without, mpjpe_cm, ...}.
Result<nlohmann::ordered_json> ScoreAblations(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options);

}  // namespace footing::eval
