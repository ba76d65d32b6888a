#pragma once

#include <cmath>
#include <vector>

#include "daemon/offline/eval/gait_trial.h"

namespace footing::eval {

/// Pushes of one size in evenly spaced directions, at evenly spaced moments of one cycle (two
/// steps, or one hop of a jump).
struct PushSweep {
  biped::GaitCommand command;
  int directions = 8;
  int phases = 12;
  double impulse_ns = 16;  ///< Over 0.1 s.
};

struct PushSweepResult {
  std::vector<int> falls;  ///< By direction; direction 0 pushes from behind, then to the left.
  int pushes = 0;
  double leg_gap_min_m = INFINITY;  ///< Between the legs (leg_gap.h), after pushes that size.
  /// Found by bisection to 1 N s, up to 64: as if who survives a push survived all smaller ones.
  double largest_survived_ns = 0;

  int all_falls() const;
};

/// Settles at the command (the seed draws a kick of 2 N s on the way and the first moment), keeps
/// the engine's state at each moment, and goes on from there with each push for 5 s. Adds to
/// `result.falls` and `pushes`; `largest_survived_ns` becomes the smallest over calls.
Result<void> RunPushSweep(const PushSweep& sweep, std::uint64_t seed, PushSweepResult& result);

}  // namespace footing::eval
