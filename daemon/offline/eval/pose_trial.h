#pragma once

#include <nlohmann/json.hpp>

#include "common/result/result.h"
#include "daemon/offline/rehearsal/rehearsal.h"
#include "daemon/simulation/reconstruction/reconstruction.h"

namespace footing::eval {

/// What is told to the reconstruction instead of its own estimates.
struct Oracle {
  bool com = false, momentum = false, feet = false;
};

/// Runs one reconstruction over a rehearsal and judges all that it tells, from
/// rehearsal.judged_from on.
Result<nlohmann::ordered_json> RunPoseTrial(const rehearsal::Rehearsal& rehearsal,
                                            const reconstruction::Models& models,
                                            const reconstruction::Options& options,
                                            const Oracle& oracle);

}  // namespace footing::eval
