#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/eval/pose_trial.h"
#include "daemon/offline/pose_run/plates.h"

namespace footing::eval {

/// What the plates measured, the centre of mass along each axis, and the same reconstruction on
/// simulated forces, over the same frames. Field `plates` of `pose --boards forces`.
Result<nlohmann::ordered_json> ScorePlates(const pose_run::PlateRun& plates,
                                           const reconstruction::Models& models,
                                           const reconstruction::Options& options,
                                           const Oracle& oracle);

}  // namespace footing::eval
