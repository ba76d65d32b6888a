#pragma once

#include <cstdint>
#include <vector>

#include "common/result/result.h"
#include "daemon/simulation/engine/engine.h"
#include "daemon/simulation/engine/state.h"

/// footing-tune: the gains of a gait by search over simulated trials.
namespace footing::tune {

/// What a set is tuned for.
struct Task {
  stream::Gait gait = stream::Gait::kWalk;
  double speed_mps = 0;
};

/// What was seen in one trial. A duration or length that was never seen whole is 0.
struct TrialResult {
  double survived = 1;         ///< Fraction of the trial before a fall.
  double speed_error_mps = 0;  ///< Root mean square, of the speed over the last half second.
  double flight_s = 0;         ///< Mean; running, jumping: no foot down; else one foot's swing.
  double stance_s = 0;         ///< Mean; running, jumping: a foot down; else one foot's.
  double stride_m = 0;         ///< Mean; from a foot's touchdown to its next.
  double height_m = 0.2;       ///< That was commanded, of a jump.
};

inline constexpr double kTrialS = 5;

/// States in which trials begin: the gait settled at its speed under the table's gains, at moments
/// of the cycle that `seed` draws. An error when it falls on the way.
Result<std::vector<engine::EngineState>> SettledStates(engine::GaitEngine& engine, const Task& task,
                                                       int count, std::uint64_t seed);

/// One trial of kTrialS from `start`, under the gains that the engine uses: a kick of 0.1 s from
/// any side after 1.5 to 2.2 s (step and walk 4 to 20 N s, run 10 to 40, jump 8 to 28), in every
/// second trial 5 degrees a step to either side, jumps of 0.1 to 0.4 m. All drawn from `seed`,
/// which is mixed so that no trial of footing-eval draws the same.
TrialResult RunTrial(engine::GaitEngine& engine, const engine::EngineState& start, const Task& task,
                     std::uint64_t seed);

/// The same number never comes of two different pairs in practice (splitmix64).
std::uint64_t MixSeeds(std::uint64_t a, std::uint64_t b);

}  // namespace footing::tune
