#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "daemon/offline/learning/network.h"
#include "daemon/offline/pose_run/held_hands.h"
#include "daemon/simulation/pose/arm_model.h"

namespace footing::eval {

/// The arms estimated from the devices of a run against the truth from the T-pose on, beside an arm
/// that never moves, beside the kinematic prediction alone and beside these networks; the fields of
/// `footing-eval arm`. Straps on both segments need no model. `observed`: the devices whose
/// observability is reported (ArmBound); none where the motion repeats itself.
nlohmann::ordered_json RunArmTrial(const pose_run::ArmRun& run,
                                   const std::optional<arms::ArmModel>& model,
                                   const std::vector<arm_network::ArmNetwork>& networks,
                                   const std::optional<pose_run::Places>& observed);

}  // namespace footing::eval
