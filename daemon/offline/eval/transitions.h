#pragma once

#include <optional>

#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/report.h"

namespace footing::eval {

/// The first flight of a jump out of another gait, from its lift-off to its touchdown.
struct Leap {
  double flight_s = 0;
  double length_m = 0;     ///< That the COM moves, level.
  double rise_m = 0;       ///< Rise of the COM above its height at lift-off; ideally commanded_m.
  double commanded_m = 0;  ///< That height.
};

/// Outcome of one change of gait.
struct TransitionResult {
  bool fell = false;
  bool succeeded = false;
  double latency_s = 0;      ///< Command to the new gait's controller; when that was reached.
  std::optional<Leap> leap;  ///< Leap of a transition to jumping, once it is over.
};

/// A command of this gait from the range in which people will give it: walk 0.2 to 1.4 m/s, run
/// 1.5 to 4.5, jump 0 to 1, jump height 0.1 to 0.35 m.
biped::GaitCommand DrawCommand(stream::Gait gait, Random& random);

/// Given in place of what is drawn.
struct TransitionSpeeds {
  std::optional<double> from_mps;
  std::optional<double> to_mps;
  std::optional<double> height_m;  ///< Height of the jumps.
};

/// `from` for 7 to 8.5 s with a kick of 2 N s, then `to`. It succeeded when the new gait's states
/// are reached and then 5 s go by upright in it, at whose end the mean speed of the last second is
/// within 0.1 m/s of the command.
Result<TransitionResult> RunTransition(stream::Gait from, stream::Gait to, std::uint64_t seed,
                                       const TransitionSpeeds& speeds = {});

/// `transitions`: from one gait to another, from random speeds, heights and moments.
void AddTransitionsCommand(CLI::App& app, Shared& shared);

}  // namespace footing::eval
