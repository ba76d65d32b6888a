#include "daemon/offline/tune/trial.h"

#include <cmath>

#include "common/units/units.h"
#include "common/virtual/noise/random.h"
#include "daemon/offline/tune/gait_meter.h"

namespace footing::tune {
namespace {

using stream::Gait;

constexpr double kStepS = 0.001;
constexpr std::uint64_t kTuneSalt = 0x666f6f74696e67;  // Keeps tuning off the suite's seeds.
constexpr double kSettleS = 6;
constexpr double kBetweenStatesS = 0.61;

struct Kick {
  double min_ns, max_ns;
};

Kick KickOf(Gait gait) {
  switch (gait) {
    case Gait::kRun:
      return {10, 40};
    case Gait::kJump:
      return {8, 28};
    case Gait::kStep:
    case Gait::kWalk:
    case Gait::kUnspecified:
      return {4, 20};
  }
  return {4, 20};
}

engine::EngineInputs Inputs(const Task& task) {
  engine::EngineInputs inputs;
  inputs.direct = true;
  inputs.direct_command = {.gait = task.gait, .speed_mps = task.speed_mps};
  return inputs;
}

bool Fell(const engine::EngineOutput& output) {
  for (int i = 0; i < output.event_count; ++i) {
    if (output.events[static_cast<std::size_t>(i)].kind == engine::EventKind::kFall) return true;
  }
  return false;
}

}  // namespace

std::uint64_t MixSeeds(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a * 0x9e3779b97f4a7c15u + b + kTuneSalt;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

Result<std::vector<engine::EngineState>> SettledStates(engine::GaitEngine& engine, const Task& task,
                                                       int count, std::uint64_t seed) {
  noise::Random random(MixSeeds(seed, 0));
  const engine::EngineInputs inputs = Inputs(task);
  std::vector<engine::EngineState> states;
  double until_s = kSettleS + task.speed_mps;
  for (int i = 0; i < count; ++i) {
    until_s += kBetweenStatesS + random.Uniform(0, 0.8);
    while (engine.Output().time_s < until_s) {
      engine.Advance(inputs);
      if (Fell(engine.Output())) {
        return Failure(std::string(stream::Name(task.gait)) + " at " +
                       std::to_string(task.speed_mps) +
                       " m/s falls with the gains to start from; start from a lower speed");
      }
    }
    states.push_back(engine.Save());
  }
  return states;
}

TrialResult RunTrial(engine::GaitEngine& engine, const engine::EngineState& start, const Task& task,
                     std::uint64_t seed) {
  noise::Random random(MixSeeds(seed, 1));
  engine::EngineInputs inputs = Inputs(task);
  inputs.features_number = start.inputs.features_number;
  inputs.push_number = start.inputs.push_number;
  const double kick_s = random.Uniform(1.5, 2.2);
  const double direction_rad = random.Uniform(-kPi, kPi);
  const Kick kick = KickOf(task.gait);
  const double kick_ns = random.Uniform(kick.min_ns, kick.max_ns);
  const double turn_rad = DegreesToRadians(random.Uniform() < 0.5 ? 5 : -5);
  if (random.Uniform() < 0.5) inputs.direct_command.turn_per_step_rad = turn_rad;
  if (task.gait == Gait::kJump) inputs.direct_command.height_m = random.Uniform(0.1, 0.4);

  engine.Restore(start);
  GaitMeter meter(task);
  const auto steps = static_cast<int>(std::lround(kTrialS / kStepS));
  const auto kick_step = static_cast<int>(std::lround(kick_s / kStepS));
  TrialResult result;
  for (int i = 0; i < steps; ++i) {
    if (i == kick_step) {
      ++inputs.push_number;
      inputs.push_impulse_W_ns =
          kick_ns * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
    }
    engine.Advance(inputs);
    if (Fell(engine.Output())) {
      result.survived = static_cast<double>(i) / steps;
      break;
    }
    meter.Add(engine.Output(), kStepS);
  }
  meter.Report(result);
  result.height_m = inputs.direct_command.height_m;
  return result;
}

}  // namespace footing::tune
