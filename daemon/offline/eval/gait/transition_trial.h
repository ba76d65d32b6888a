#pragma once

#include <optional>

#include "daemon/offline/eval/gait/trial.h"

namespace footing::eval {

struct TransitionResult {
  bool fell = false;
  bool succeeded = false;
  double latency_s = 0;  ///< Command to the new gait's controller; when that was reached.
};

/// A command of this gait from the range in which people will give it: walk 0.2 to 1.4 m/s, run
/// 1.5 to 4.5, jump 0 to 1, jump height 0.1 to 0.35 m.
biped::GaitCommand DrawCommand(stream::Gait gait, Random& random);

/// Speeds given in place of the drawn ones, m/s.
struct TransitionSpeeds {
  std::optional<double> from_mps;
  std::optional<double> to_mps;
};

/// `from` for 7 to 8.5 s with a kick of 2 N s, then `to`. It succeeded when the new gait's states
/// are reached and then 5 s go by upright in it, at whose end the mean speed of the last second is
/// within 0.1 m/s of the command.
Result<TransitionResult> RunTransition(stream::Gait from, stream::Gait to, std::uint64_t seed,
                                       const TransitionSpeeds& speeds = {});

}  // namespace footing::eval
