#include "daemon/offline/eval/monkey_command.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/cli/cli.h"
#include "common/units/units.h"
#include "daemon/offline/eval/gait_trial.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr std::array kGaits{Gait::kStep, Gait::kWalk, Gait::kRun, Gait::kJump};
constexpr double kTrackedMps = 0.25;
constexpr double kLongCommandS = 3;

struct Options {
  double seconds = 600;
  int trials = 1;
  std::string seed = "1";
  bool gentle = false;
};

/// Mean speed along the heading over the last half second, about one step of any gait: within a
/// step the speed rises and falls by nature.
class SpeedOverAStep {
 public:
  void Add(double speed_mps) {
    sum_mps_ += speed_mps - last_mps_[next_];
    last_mps_[next_] = speed_mps;
    next_ = (next_ + 1) % last_mps_.size();
  }
  double mean_mps() const { return sum_mps_ / static_cast<double>(last_mps_.size()); }

 private:
  std::array<double, 500> last_mps_{};  ///< One a millisecond.
  std::size_t next_ = 0;
  double sum_mps_ = 0;
};

/// One command, from when it is given to the next one.
struct Given {
  double time_s = 0;
  double speed_mps = 0;
  std::uint64_t falls_before = 0;
};

struct Outcome {
  double simulated_s = 0;
  int falls = 0;
  std::array<int, 4> falls_by_gait{};
  std::uint64_t commands = 0;
  std::uint64_t long_commands = 0;
  std::uint64_t tracked = 0;  ///< Of the long ones.
};

/// Counts a command at its end. One that lasted 3 s or more was tracked when its gait runs, it saw
/// no fall, and its speed is kept to 0.25 m/s over the last step.
void Judge(const Given& given, double time_s, const stream::GaitState& state, double mean_mps,
           Outcome& outcome) {
  ++outcome.commands;
  if (time_s - given.time_s < kLongCommandS) return;
  ++outcome.long_commands;
  const bool tracked = !state.pending && state.falls == given.falls_before &&
                       std::fabs(mean_mps - given.speed_mps) < kTrackedMps;
  outcome.tracked += tracked ? 1 : 0;
}

/// Gentle: run to 3 m/s and walk to 1, instead of 4 and 1.3.
biped::GaitCommand DrawCommand(bool gentle, Random& random) {
  biped::GaitCommand command;
  command.gait = kGaits[static_cast<std::size_t>(random.Uniform(0, 3.999))];
  const double part = random.Uniform(0, 1);
  if (command.gait == Gait::kWalk) command.speed_mps = part * (gentle ? 1.0 : 1.3);
  if (command.gait == Gait::kRun) command.speed_mps = 1 + part * (gentle ? 2.0 : 3.0);
  if (command.gait == Gait::kJump) command.speed_mps = part * 1.5;
  command.height_m = random.Uniform(0.08, 0.35);
  const bool turns = random.Uniform(0, 1) < 0.5;
  command.turn_per_step_rad = turns ? DegreesToRadians(random.Uniform(-5, 5)) : 0;
  return command;
}

/// One trial; a fall is put back by the engine and the trial goes on.
Result<void> RunTrial(const Options& options, std::uint64_t seed, Outcome& outcome) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  Random random(seed);
  Walker walker(*engine);
  double next_s = kLongCommandS;
  Given given;
  SpeedOverAStep speed;
  for (double time_s = 0; time_s < options.seconds;) {
    if (time_s >= next_s) {
      const stream::GaitState& state = engine->Output().gait;
      if (given.time_s > 0) Judge(given, time_s, state, speed.mean_mps(), outcome);
      next_s = time_s + random.Uniform(0.5, 4);
      const biped::GaitCommand command = DrawCommand(options.gentle, random);
      given = {time_s, command.speed_mps, state.falls};
      walker.Command(command);
    }
    const engine::EngineOutput& output = walker.Advance();
    time_s = output.time_s;
    speed.Add(output.gait.speed_mps);
    for (int i = 0; i < output.event_count; ++i) {
      const engine::EngineEvent& event = output.events[static_cast<std::size_t>(i)];
      if (event.kind != engine::EventKind::kFall) continue;
      ++outcome.falls;
      ++outcome.falls_by_gait[static_cast<std::size_t>(event.from) - 1];
    }
  }
  outcome.simulated_s += options.seconds;
  return {};
}

int Run(const Options& options, bool json) {
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  Outcome outcome;
  for (int i = 0; i < options.trials; ++i) {
    if (auto run = RunTrial(options, TrialSeed(*seed, i), outcome); !run) {
      return cli::Report(run.error());
    }
  }
  const auto judged = static_cast<double>(std::max<std::uint64_t>(1, outcome.long_commands));
  nlohmann::ordered_json report{
      {"seed", *seed},
      {"simulated_s", outcome.simulated_s},
      {"falls", outcome.falls},
      {"mean_time_between_falls_s", outcome.simulated_s / std::max(1, outcome.falls)},
      {"falls_by_gait", nlohmann::ordered_json::object()},
      {"commands_tracked_fraction", static_cast<double>(outcome.tracked) / judged},
      {"commands", outcome.commands},
      {"commands_of_3_s", outcome.long_commands}};
  for (std::size_t i = 0; i < kGaits.size(); ++i) {
    report["falls_by_gait"][Name(kGaits[i])] = outcome.falls_by_gait[i];
  }
  if (json) {
    std::printf("%s\n", report.dump().c_str());
  } else {
    for (const auto& [key, value] : report.items()) {
      std::printf("%-26s %s\n", key.c_str(), value.dump().c_str());
    }
  }
  return 0;
}

}  // namespace

void AddMonkeyCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("monkey", "Random commands every 0.5 to 4 s");
  auto options = std::make_shared<Options>();
  command->add_option("--seconds", options->seconds, "Of each trial")
      ->check(CLI::Range(1.0, 36000.0));
  command->add_option("--trials", options->trials, "How many")->check(CLI::Range(1, 10000));
  command->add_option("--seed", options->seed, "A number, or random");
  command->add_flag("--gentle", options->gentle, "Run to 3 m/s and walk to 1, not 4 and 1.3");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared.json); });
}

}  // namespace footing::eval
