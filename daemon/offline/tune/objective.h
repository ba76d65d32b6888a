#pragma once

#include "daemon/offline/tune/trial.h"

namespace footing::tune {

/// The terms of the paper's objective (section 5, Optimization), each at least 0, lower is better.
/// The paper names what it evaluates and gives no weights; these are ours. A trial that turns has
/// no change of gait, so heading and latency never come together.
struct Cost {
  double failure = 0;  ///< Of a fall: 10 + 10 (1 - fraction survived), more than all else can be.
  double speed = 0;    ///< (speed error / 0.15 m/s)^2, at most 2.
  double flight = 0;   ///< Flight or swing: 0.25 (relative deviation / 10 %)^2, at most 1.
  double stance = 0;   ///< As flight.
  double stride = 0;   ///< As flight; left out below 0.3 m/s, where a stride has no length.
  double heading = 0;  ///< Turning: (heading error / 5 degrees)^2, at most 2.
  double legs = 0;  ///< Running: (what the gap lacks of 3 cm / 3 cm)^2, at most 2; 1: they touch.
  double latency = 0;  ///< Of a change to walking: (what is more than wanted / 10 %)^2, at most 2.

  double total() const {
    return failure + speed + flight + stance + stride + heading + legs + latency;
  }
};

/// Durations that are aimed at.
struct Wanted {
  double flight_s, stance_s, stride_m, latency_s;
};

/// Those of the gaits as tuned by hand, so that a better score is robustness and obedience, not
/// another look. Step and walk: swing 0.32 s, stance 0.40 s. Run: flight 0.28 s, stance 0.20 s at
/// 2 m/s, 0.13 s at 5. Jump: the flight of the commanded height, stance 0.18 s. From running to
/// walking: 0.6 s and 0.1 s for each m/s, which their medians are from 3.5 to 6 m/s.
Wanted WantedOf(const Task& task, double height_m);

Cost CostOf(const Task& task, const TrialResult& result);

}  // namespace footing::tune
