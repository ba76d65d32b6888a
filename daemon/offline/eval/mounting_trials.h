#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "daemon/offline/eval/walk.h"

namespace footing::eval {

/// The walk `trials` times, each time with both sensors turned at random: errors of the features
///
///   perfect  of the same sensors mounted perfectly
///   solved   turned, the rotation solved from standing and three steps
///
/// and how each solved rotation differs from the true one. Sensors round as footingd's reports and
/// their own calibrations do. `bar` is 1.5 times the 95th percentile of what perfect reaches;
/// `declared_bar` 1.5 times what `features --synthetic` holds a perfect mounting to.
nlohmann::json MeasureMounting(const MountingWalk& walk, int trials, std::uint64_t seed);

}  // namespace footing::eval
