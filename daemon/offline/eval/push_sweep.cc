#include "daemon/offline/eval/push_sweep.h"

#include <algorithm>
#include <numeric>

#include "common/base/units.h"
#include "daemon/simulation/engine/state.h"

namespace footing::eval {
namespace {

constexpr double kPushSettleS = 4;  ///< And a second for each m/s.
constexpr double kPushKickNs = 2;
constexpr double kPushUprightS = 5;
constexpr double kLargestNs = 64;
constexpr double kResolutionNs = 1;
constexpr double kNoCycleS = 5;  ///< A cycle that takes longer is none.

/// States of one undisturbed cycle.
class Cycle {
 public:
  Cycle(engine::GaitEngine& engine, const biped::GaitCommand& command)
      : engine_(engine), command_(command) {}

  Result<void> Record(int phases, Random& random);
  bool Falls(int phase, double impulse_ns, double direction_rad);
  int phases() const { return static_cast<int>(states_.size()); }
  double leg_gap_min_m() const { return leg_gap_min_m_; }

 private:
  Walker NewWalker() {
    Walker walker(engine_);
    walker.Command(command_);
    return walker;
  }
  static void Run(Walker& walker, double until_s) {
    while (!walker.fell() && walker.Advance().time_s < until_s) {
    }
  }
  static double NextTouchdown(Walker& walker) {
    const engine::EngineOutput& output = walker.Advance();
    const std::uint64_t steps = output.gait.steps;
    const double latest_s = output.time_s + kNoCycleS;
    while (output.gait.steps == steps && output.time_s < latest_s && !walker.fell()) {
      walker.Advance();
    }
    return output.time_s;
  }

  engine::GaitEngine& engine_;
  biped::GaitCommand command_;
  std::vector<engine::EngineState> states_;
  std::uint64_t pushes_ = 1;
  double leg_gap_min_m_ = INFINITY;
};

Result<void> Cycle::Record(int phases, Random& random) {
  Walker walker = NewWalker();
  Run(walker, random.Uniform(1, 2));
  walker.Push(kPushKickNs, random.Uniform(-kPi, kPi));
  Run(walker, kPushSettleS + command_.speed_mps + random.Uniform(0, 1));
  const double start_s = NextTouchdown(walker);
  double end_s = NextTouchdown(walker);
  if (command_.gait != stream::Gait::kJump) end_s = NextTouchdown(walker);
  if (walker.fell()) return InvalidData("fell before any push: nothing to sweep");
  const double spacing_s = (end_s - start_s) / phases;
  const double first_s = end_s + random.Uniform(0, spacing_s);
  for (int i = 0; i < phases; ++i) {
    Run(walker, first_s + i * spacing_s);
    states_.push_back(engine_.Save());
  }
  return {};
}

bool Cycle::Falls(int phase, double impulse_ns, double direction_rad) {
  const engine::EngineState& state = states_[static_cast<std::size_t>(phase)];
  engine_.Restore(state);
  Walker walker = NewWalker();
  walker.Push(impulse_ns, direction_rad, ++pushes_);
  Run(walker, engine_.Output().time_s + kPushUprightS);
  leg_gap_min_m_ = std::min(leg_gap_min_m_, walker.leg_gap_min_m());
  return walker.fell();
}

double DirectionRad(int index, int directions) { return index * 2 * kPi / directions; }

bool AllSurvive(Cycle& cycle, int directions, double impulse_ns) {
  for (int d = 0; d < directions; ++d) {
    for (int p = 0; p < cycle.phases(); ++p) {
      if (cycle.Falls(p, impulse_ns, DirectionRad(d, directions))) return false;
    }
  }
  return true;
}

double LargestSurvived(Cycle& cycle, int directions, double survived_ns, double fell_ns) {
  while (fell_ns - survived_ns > kResolutionNs) {
    const double middle_ns = (survived_ns + fell_ns) / 2;
    (AllSurvive(cycle, directions, middle_ns) ? survived_ns : fell_ns) = middle_ns;
  }
  return survived_ns;
}

}  // namespace

int PushSweepResult::all_falls() const { return std::accumulate(falls.begin(), falls.end(), 0); }

Result<void> RunPushSweep(const PushSweep& sweep, std::uint64_t seed, PushSweepResult& result) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  Random random(seed);
  Cycle cycle(*engine, sweep.command);
  if (auto recorded = cycle.Record(sweep.phases, random); !recorded) return recorded.error();

  const bool first = result.pushes == 0;
  if (first) result.falls.assign(static_cast<std::size_t>(sweep.directions), 0);
  int falls = 0;
  for (int d = 0; d < sweep.directions; ++d) {
    for (int p = 0; p < sweep.phases; ++p) {
      const bool fell = cycle.Falls(p, sweep.impulse_ns, DirectionRad(d, sweep.directions));
      result.falls[static_cast<std::size_t>(d)] += fell ? 1 : 0;
      falls += fell ? 1 : 0;
    }
  }
  result.pushes += sweep.directions * sweep.phases;
  result.leg_gap_min_m = std::min(result.leg_gap_min_m, cycle.leg_gap_min_m());
  const double largest_ns = falls == 0
                                ? LargestSurvived(cycle, sweep.directions, sweep.impulse_ns,
                                                  std::max(kLargestNs, sweep.impulse_ns))
                                : LargestSurvived(cycle, sweep.directions, 0, sweep.impulse_ns);
  result.largest_survived_ns =
      first ? largest_ns : std::min(result.largest_survived_ns, largest_ns);
  return {};
}

}  // namespace footing::eval
