#pragma once

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "daemon/offline/pose_run/pose_run.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// What little knowledge would reach on the same frames, from `start` on: a T-pose that stays, the
/// mean pose of the basis, both where the T-pose was, and the same solver and prior from hands and
/// feet alone.
Result<nlohmann::ordered_json> ScoreBaselines(const pose_run::PoseRun& run,
                                              const reconstruction::Models& models,
                                              const reconstruction::Options& options,
                                              std::size_t start);

}  // namespace footing::eval
