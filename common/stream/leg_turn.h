#pragma once

#include <array>
#include <string>

#include "common/stream/user_interface.h"

namespace footing::stream {

/// Limbs that can turn with the interface leg.
inline constexpr std::array kLegTurnSources = {TurnSource::kHead, TurnSource::kFeet,
                                               TurnSource::kTrunk};

/// "head", "feet" or "trunk": what can turn with the interface leg; kUnspecified when it is none of
/// them.
TurnSource LegTurnSourceNamed(const std::string& name);

}  // namespace footing::stream
