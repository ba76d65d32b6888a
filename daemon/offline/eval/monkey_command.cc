#include "daemon/offline/eval/monkey_command.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/units.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/progress.h"
#include "daemon/offline/analysis/tracking.h"
#include "daemon/simulation/biped/limits.h"

namespace footing::eval {
namespace {

using stream::Gait;
using tracking::Tracking;

using stream::kGaits;

struct MonkeyOptions {
  double seconds = 600;
  int trials = 1;
  std::string seed = "1";
  bool gentle = false;
  bool whole_range = false;
};

/// Where one is to look for what went wrong.
struct Fall {
  int trial;
  double time_s;
  Gait gait;
  const char* why;
  biped::GaitCommand command;
  double commanded_s;  ///< Before the fall.
};

struct Outcome {
  double simulated_s = 0;
  int falls = 0;
  std::array<int, kGaits.size()> falls_by_gait{};
  std::vector<Fall> fell;
  std::array<int, tracking::kTrackings> commands{};  ///< By what became of them.

  int of(Tracking became) const { return commands[static_cast<std::size_t>(became)]; }
};

/// Evenly over all that biped::Limited accepts.
biped::GaitCommand DrawAccepted(Random& random) {
  constexpr double kBeyond = 100;
  biped::GaitCommand command;
  command.gait = kGaits[static_cast<std::size_t>(random.Uniform(0, kGaits.size() - 0.001))];
  const biped::GaitCommand fastest =
      biped::Limited({.gait = command.gait, .speed_mps = kBeyond, .height_m = kBeyond});
  command.speed_mps = random.Uniform(0, fastest.speed_mps);
  const biped::GaitCommand highest =
      biped::Limited({.gait = command.gait, .speed_mps = command.speed_mps, .height_m = kBeyond});
  const double lowest_m = biped::Limited({.gait = command.gait, .height_m = 0}).height_m;
  command.height_m = random.Uniform(lowest_m, highest.height_m);
  const double turn_max_rad = biped::TurnLimit(command.gait, command.speed_mps);
  const bool turns = random.Uniform(0, 1) < 0.5;
  command.turn_per_step_rad = turns ? random.Uniform(-turn_max_rad, turn_max_rad) : 0;
  return command;
}

/// Gentle: run to 3 m/s and walk to 1, instead of 4 and 1.3.
biped::GaitCommand DrawCommand(bool gentle, Random& random) {
  biped::GaitCommand command;
  command.gait = kGaits[static_cast<std::size_t>(random.Uniform(0, kGaits.size() - 0.001))];
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
Result<void> RunTrial(const MonkeyOptions& options, std::uint64_t seed, int trial,
                      Progress& progress, Outcome& outcome) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  Random random(TrialSeed(seed, trial));
  Walker walker(*engine);
  double next_s = tracking::kLongCommandS;
  tracking::GivenCommand given;
  tracking::SpeedOverAStep speed;
  for (double time_s = 0; time_s < options.seconds;) {
    if (time_s >= next_s) {
      const stream::GaitState& state = engine->Output().gait;
      if (given.time_s > 0) {
        const Tracking became = tracking::CheckTracking(given, time_s, state, speed.mean_mps());
        ++outcome.commands[static_cast<std::size_t>(became)];
      }
      next_s = time_s + random.Uniform(0.5, 4);
      progress.Done(outcome.simulated_s + time_s, clock::MonotonicNs(), std::cerr);
      const biped::GaitCommand command =
          options.whole_range ? DrawAccepted(random) : DrawCommand(options.gentle, random);
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
      ++outcome.falls_by_gait[stream::IndexOf(event.from)];
      outcome.fell.push_back({trial, time_s, event.from, event.text, walker.inputs().direct_command,
                              time_s - given.time_s});
    }
  }
  outcome.simulated_s += options.seconds;
  return {};
}

nlohmann::ordered_json ToJson(const Fall& fall) {
  return {{"trial", fall.trial},
          {"time_s", fall.time_s},
          {"gait", Name(fall.gait)},
          {"why", fall.why},
          {"commanded", Name(fall.command.gait)},
          {"commanded_s_before", fall.commanded_s},
          {"speed_mps", fall.command.speed_mps},
          {"height_m", fall.command.height_m},
          {"turn_deg", RadiansToDegrees(fall.command.turn_per_step_rad)}};
}

int RunMonkey(const MonkeyOptions& options, bool json) {
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  Outcome outcome;
  Progress progress("monkey", "s simulated", options.trials * options.seconds,
                    clock::MonotonicNs());
  for (int i = 0; i < options.trials; ++i) {
    if (auto run = RunTrial(options, *seed, i, progress, outcome); !run) {
      return cli::Report(run.error());
    }
  }
  const int commands = std::accumulate(outcome.commands.begin(), outcome.commands.end(), 0);
  const int judged = commands - outcome.of(Tracking::kShort);
  nlohmann::ordered_json tracked;  // Null: no command lasted long enough.
  if (judged > 0) tracked = static_cast<double>(outcome.of(Tracking::kTracked)) / judged;
  nlohmann::ordered_json report{
      {"seed", *seed},
      {"simulated_s", outcome.simulated_s},
      {"falls", outcome.falls},
      {"mean_time_between_falls_s", outcome.simulated_s / std::max(1, outcome.falls)},
      {"falls_by_gait", nlohmann::ordered_json::object()},
      {"commands_tracked_fraction", tracked},
      {"untracked",
       {{"gait", outcome.of(Tracking::kOtherGait)},
        {"fell", outcome.of(Tracking::kFell)},
        {"speed", outcome.of(Tracking::kOffSpeed)}}},
      {"commands", commands},
      {"commands_of_3_s", judged}};
  for (std::size_t i = 0; i < kGaits.size(); ++i) {
    report["falls_by_gait"][Name(kGaits[i])] = outcome.falls_by_gait[i];
  }
  report["fell"] = nlohmann::ordered_json::array();
  for (const Fall& fall : outcome.fell) report["fell"].push_back(ToJson(fall));
  PrintReport(report, json);
  return 0;
}

}  // namespace

void AddMonkeyCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand(
      "monkey", "Trials with random gait, speed, height and turn every 0.5 to 4 s");
  auto options = std::make_shared<MonkeyOptions>();
  command->add_option("--seconds", options->seconds, "Duration of each trial, s")
      ->check(CLI::Range(1.0, 36000.0));
  command->add_option("--trials", options->trials, "Number of trials")->check(CLI::Range(1, 10000));
  command->add_option("--seed", options->seed, "Seed: a number, or random");
  CLI::Option* gentle = command->add_flag(
      "--gentle", options->gentle, "Limit runs to 3 m/s and walks to 1 m/s, in place of 4 and 1.3");
  command
      ->add_flag("--whole-range", options->whole_range,
                 "Draw every speed, height and turn that is accepted, run to 6 m/s")
      ->excludes(gentle);
  command->callback([options, &shared] { shared.exit_code = RunMonkey(*options, shared.json); });
}

}  // namespace footing::eval
