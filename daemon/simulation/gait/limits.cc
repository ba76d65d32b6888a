#include "daemon/simulation/gait/limits.h"

#include <algorithm>
#include <cmath>

namespace footing::gait {
namespace {

using stream::Gait;

struct StableRange {
  Gait gait;
  double speed_max_mps;
};

constexpr StableRange kStableRanges[] = {
    {Gait::kStep, 0}, {Gait::kWalk, 1.75}, {Gait::kRun, 6.0}, {Gait::kJump, 2.0}};
constexpr double kHeightMinM = 0.05;
constexpr double kHeightMaxM = 0.5;
constexpr double kTurnMaxRad = 0.14;  // 8 degrees a step.

}  // namespace

biped::GaitCommand Limited(const biped::GaitCommand& command) {
  const bool finite = std::isfinite(command.speed_mps) && std::isfinite(command.height_m) &&
                      std::isfinite(command.turn_per_step_rad) && std::isfinite(command.cadence_hz);
  if (!finite) return {};
  for (const StableRange& range : kStableRanges) {
    if (range.gait != command.gait) continue;
    return {.gait = command.gait,
            .speed_mps = std::clamp(command.speed_mps, 0.0, range.speed_max_mps),
            .height_m = std::clamp(command.height_m, kHeightMinM, kHeightMaxM),
            .turn_per_step_rad = std::clamp(command.turn_per_step_rad, -kTurnMaxRad, kTurnMaxRad),
            .cadence_hz = std::max(0.0, command.cadence_hz)};
  }
  return {};
}

}  // namespace footing::gait
