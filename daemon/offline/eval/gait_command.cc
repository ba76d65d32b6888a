#include "daemon/offline/eval/gait_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/fnv.h"
#include "common/base/units.h"
#include "daemon/offline/eval/gait_options.h"
#include "daemon/offline/eval/ground_course.h"
#include "daemon/offline/eval/pit_course.h"
#include "daemon/offline/eval/push_sweep.h"
#include "daemon/offline/eval/statistics.h"
#include "daemon/offline/eval/step_cost.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/progress.h"
#include "daemon/simulation/biped/limits.h"

namespace footing::eval {
namespace {

struct Trials {
  int falls = 0;
  int pits = 0, steps = 0, crossed = 0;
  double survived_s_min = 0;
  double speed_sum_mps = 0;
  double apex_sum_m = 0;
  RootMeanSquare speed_error, heading_error;
  double leg_gap_min_m = INFINITY;
  double root_force_max_n = 0;
  double simulated_s = 0, cpu_s = 0, wall_s = 0;
  std::uint64_t state_hash = 0;
};

double HeightOf(const GaitOptions& options) {
  constexpr double kHeightM = 0.2;
  const double fallback_m =
      options.pit_m ? SensibleHeight(*options.pit_m, options.speed_mps) : kHeightM;
  return options.height_m.value_or(fallback_m);
}

biped::GaitCommand CommandOf(const GaitOptions& options) {
  return biped::Limited({.gait = stream::GaitNamed(options.gait),
                         .speed_mps = options.speed_mps,
                         .height_m = HeightOf(options),
                         .turn_per_step_rad = DegreesToRadians(options.turn_deg)});
}

/// The kick comes once the speed is reached, at a moment of the cycle that is drawn or given.
double PushTime(const GaitOptions& options, Random& random) {
  constexpr double kCycleS = 0.74;  // Two walking steps.
  const double phase = options.push_phase >= 0 ? options.push_phase : random.Uniform(0, 1);
  return std::min(0.3 * options.seconds, 3 + options.speed_mps) + phase * kCycleS;
}

std::optional<GroundCourse> GroundCourseOf(const GaitOptions& options, double length_m,
                                           Random& random) {
  if (options.step_m != 0) return MakeStepCourse(options.step_m, length_m, random);
  if (options.slope_deg == 0) return std::nullopt;
  return MakeSlopeCourse(options.slope_deg, options.speed_mps, length_m, random);
}

Result<void> RunTrial(const GaitOptions& options, std::uint64_t seed, Trials& trials) {
  Random random(seed);
  const double length_m = options.speed_mps * options.seconds;
  const PitCourse course =
      options.pit_m ? MakePitCourse(*options.pit_m, length_m, random) : PitCourse{};
  const std::optional<GroundCourse> ground =
      options.pit_m ? std::nullopt : GroundCourseOf(options, length_m, random);
  Result<engine::GaitEngine> engine = options.pit_m ? NewEngineOn(course.track)
                                      : ground      ? NewEngineOn(ground->track)
                                                    : NewEngine();
  if (!engine) return engine.error();
  const double push_s = PushTime(options, random);
  const double drawn_deg = random.Uniform(0, 360);
  const double direction_rad = DegreesToRadians(options.push_direction_deg.value_or(drawn_deg));
  const biped::GaitCommand command = CommandOf(options);
  const double step_s = engine::EngineConfig{}.step_s;
  const auto steps = static_cast<std::uint64_t>(options.seconds / step_s + 0.5);

  Walker walker(*engine);
  walker.Command(command);
  PitPilot pilot(course, command, command.height_m,
                 options.no_jump ? -INFINITY : options.jump_lead_s);
  std::optional<GroundPilot> ground_pilot;
  if (ground) ground_pilot.emplace(*ground, command, random);
  GaitStatistics statistics(command.speed_mps);
  double survived_s = 0;
  bool pushed = false;
  while (survived_s < options.seconds) {
    if (!pushed && (ground_pilot ? ground_pilot->kick_due() : survived_s >= push_s)) {
      walker.Push(options.push_ns, direction_rad);
      pushed = true;
    }
    const engine::EngineOutput& output = walker.Advance();
    survived_s = output.time_s;
    if (options.pit_m) walker.Command(pilot.Command(output));
    if (ground_pilot) walker.Command(ground_pilot->Command(output));
    if (walker.fell() || output.step >= steps) break;
    const bool settled =
        survived_s > 0.4 * options.seconds && (!ground_pilot || ground_pilot->settled());
    if (settled) statistics.Add(output, step_s);
  }
  const engine::EngineOutput& last = engine->Output();
  trials.falls += walker.fell() ? 1 : 0;
  trials.pits += pilot.met(walker.fell());
  trials.crossed += pilot.crossed();
  if (ground_pilot) trials.steps += ground_pilot->met(walker.fell());
  if (ground_pilot) trials.crossed += ground_pilot->crossed();
  trials.survived_s_min = std::min(trials.survived_s_min, survived_s);
  trials.simulated_s += survived_s;
  trials.speed_sum_mps += statistics.speed_mean_mps();
  trials.apex_sum_m += statistics.apex_height_m();
  trials.speed_error.Add(statistics.speed_error_rms_mps());
  trials.heading_error.Add(statistics.heading_error_rms_rad());
  trials.leg_gap_min_m = std::min(trials.leg_gap_min_m, walker.leg_gap_min_m());
  trials.root_force_max_n = std::max(trials.root_force_max_n, last.root_force_max_n);
  trials.state_hash = text::AddFnv(trials.state_hash, last.state_hash);
  return {};
}

Result<Trials> RunTrials(const GaitOptions& options, std::uint64_t seed) {
  Trials trials;
  trials.survived_s_min = options.seconds;
  const std::int64_t wall_ns = clock::MonotonicNs();
  const std::int64_t cpu_ns = clock::ThreadCpuNs();
  Progress progress("gait", "trials", options.trials, wall_ns);
  for (int i = 0; i < options.trials; ++i) {
    progress.Done(i, clock::MonotonicNs(), std::cerr);
    if (auto run = RunTrial(options, TrialSeed(seed, i), trials); !run) return run.error();
  }
  trials.cpu_s = NanosecondsToSeconds(clock::ThreadCpuNs() - cpu_ns);
  trials.wall_s = NanosecondsToSeconds(clock::MonotonicNs() - wall_ns);
  return trials;
}

std::string Hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

nlohmann::ordered_json Report(const GaitOptions& options, std::uint64_t seed, const Trials& trials,
                              double step_cost_ratio) {
  nlohmann::ordered_json report{{"gait", options.gait},
                                {"speed_mps", options.speed_mps},
                                {"height_m", CommandOf(options).height_m},
                                {"seconds", options.seconds},
                                {"seed", seed},
                                {"trials", options.trials},
                                {"falls", trials.falls},
                                {"survived_s_min", trials.survived_s_min},
                                {"speed_mean_mps", trials.speed_sum_mps / options.trials},
                                {"speed_error_rms_mps", trials.speed_error.value()},
                                {"heading_error_rms_rad", trials.heading_error.value()},
                                {"apex_height_m", trials.apex_sum_m / options.trials},
                                {"leg_gap_min_m", trials.leg_gap_min_m},
                                {"real_time_factor", trials.simulated_s / trials.cpu_s},
                                {"real_time_factor_wall", trials.simulated_s / trials.wall_s},
                                {"step_cost_ratio", step_cost_ratio},
                                {"root_force_max_n", trials.root_force_max_n},
                                {"state_hash", Hex(trials.state_hash)}};
  if (options.pit_m) {
    report["pits"] = trials.pits;
    report["crossed"] = trials.crossed;
  }
  if (options.slope_deg != 0) report["slope_deg"] = options.slope_deg;
  if (options.step_m != 0) {
    report["step_m"] = options.step_m;
    report["steps"] = trials.steps;
    report["crossed"] = trials.crossed;
  }
  return report;
}

int RunSweep(const GaitOptions& options, std::uint64_t seed, bool json) {
  const PushSweep sweep{.command = CommandOf(options),
                        .directions = options.push_directions,
                        .phases = options.push_phases,
                        .impulse_ns = options.push_ns};
  PushSweepResult result;
  Progress progress("gait", "trials", options.trials, clock::MonotonicNs());
  for (int i = 0; i < options.trials; ++i) {
    progress.Done(i, clock::MonotonicNs(), std::cerr);
    const auto run = RunPushSweep(sweep, TrialSeed(seed, i), result);
    if (!run) return cli::Report(run.error());
  }
  PrintReport({{"gait", options.gait},
               {"speed_mps", options.speed_mps},
               {"height_m", sweep.command.height_m},
               {"seed", seed},
               {"trials", options.trials},
               {"push_ns", options.push_ns},
               {"pushes", result.pushes},
               {"falls", result.all_falls()},
               {"falls_by_direction", result.falls},
               {"leg_gap_min_m", result.leg_gap_min_m},
               {"largest_survived_ns", result.largest_survived_ns}},
              json);
  return 0;
}

int Run(const GaitOptions& options, bool json) {
  if (stream::GaitNamed(options.gait) == stream::Gait::kUnspecified) {
    return cli::Report(
        UsageError("--gait " + options.gait + ": must be one of " + stream::GaitNames()));
  }
  if (options.trials < 1 || !(options.seconds > 0)) {
    return cli::Report(UsageError("--trials and --seconds must be positive"));
  }
  if (options.pit_m.has_value() + (options.slope_deg != 0) + (options.step_m != 0) > 1) {
    return cli::Report(UsageError("--slope, --step and --pit: one of them at a time"));
  }
  if (options.step_m != 0 && CommandOf(options).speed_mps == 0) {
    return cli::Report(
        UsageError("--step: none is met in place; give --speed and a gait that moves"));
  }
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  if (options.push_directions > 0) return RunSweep(options, *seed, json);
  const Result<Trials> trials = RunTrials(options, *seed);
  if (!trials) return cli::Report(trials.error());
  const Result<double> ratio =
      MeasureStepCostRatio(CommandOf(options), {.slope_deg = options.slope_deg,
                                                .step_m = options.step_m,
                                                .pit_m = options.pit_m.value_or(0)});
  if (!ratio) return cli::Report(ratio.error());
  PrintReport(Report(options, *seed, *trials, *ratio), json);
  return 0;
}

}  // namespace

void AddGaitCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("gait", "Trials of one gait, each with one push");
  auto options = std::make_shared<GaitOptions>();
  AddOptions(*command, *options);
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared.json); });
}

}  // namespace footing::eval
