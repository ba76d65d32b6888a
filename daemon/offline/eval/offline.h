#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/offline/eval/momentum_scene.h"
#include "daemon/simulation/momentum/calibration.h"

namespace footing::eval {

/// The offline smoothers over the frames from `start` on, where the T-pose was complete; evaluated
/// from `judged` on. Root mean squares along each axis, cm.
nlohmann::ordered_json OfflineJson(const MomentumScene& scene, const momentum::TPose& pose,
                                   std::size_t start, std::size_t judged);

}  // namespace footing::eval
