#include "daemon/simulation/gait/limits.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace footing::gait {
namespace {

using stream::Gait;

struct StableRange {
  Gait gait;
  double speed_max_mps;
};

constexpr StableRange kStableRanges[] = {
    {Gait::kStep, 0}, {Gait::kWalk, 1.75}, {Gait::kRun, 6.0}, {Gait::kJump, 2.0}};
static_assert(std::size(kStableRanges) == stream::kGaits.size(), "a range for every gait");
constexpr double kHeightMinM = 0.05;
constexpr double kHeightMaxM = 0.7;
/// Forward faster than the first, jumps are lower: down to the second height at 2 m/s.
constexpr double kHighestUpToMps = 1.0;
constexpr double kFastHeightMaxM = 0.5;
constexpr double kTurnMaxRad = 0.14;  // 8 degrees a step.

double HeightMax(double speed_mps, double speed_max_mps) {
  const double share = (speed_mps - kHighestUpToMps) / (speed_max_mps - kHighestUpToMps);
  return std::lerp(kHeightMaxM, kFastHeightMaxM, std::clamp(share, 0.0, 1.0));
}

}  // namespace

biped::GaitCommand Limited(const biped::GaitCommand& command) {
  const bool finite = std::isfinite(command.speed_mps) && std::isfinite(command.height_m) &&
                      std::isfinite(command.turn_per_step_rad) && std::isfinite(command.cadence_hz);
  if (!finite) return {};
  for (const StableRange& range : kStableRanges) {
    if (range.gait != command.gait) continue;
    const double speed_mps = std::clamp(command.speed_mps, 0.0, range.speed_max_mps);
    const bool jumps = command.gait == Gait::kJump;
    const double height_max_m = jumps ? HeightMax(speed_mps, range.speed_max_mps) : kHeightMaxM;
    return {.gait = command.gait,
            .speed_mps = speed_mps,
            .height_m = std::clamp(command.height_m, kHeightMinM, height_max_m),
            .turn_per_step_rad = std::clamp(command.turn_per_step_rad, -kTurnMaxRad, kTurnMaxRad),
            .cadence_hz = std::max(0.0, command.cadence_hz)};
  }
  return {};
}

}  // namespace footing::gait
