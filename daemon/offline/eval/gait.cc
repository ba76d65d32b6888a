#include "daemon/offline/eval/gait.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "daemon/offline/analysis/tracking.h"
#include "daemon/offline/eval/gait_ground.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/biped/body_state.h"

namespace footing::eval {
namespace {

struct Trials {
  int falls = 0;
  int pits = 0, steps = 0, crossed = 0;
  double survived_s_min = 0;
  double speed_sum_mps = 0;
  double aside_sum_mps = 0;
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

/// A tow begins at a random moment within a second from here on.
constexpr double kTowFromS = 2;

std::optional<GroundCourse> GroundCourseOf(const GaitOptions& options, double length_m,
                                           Random& random) {
  if (options.step_m != 0) return MakeStepCourse(options.step_m, length_m, random);
  if (options.slope_deg == 0) return std::nullopt;
  return MakeSlopeCourse(options.slope_deg, options.speed_mps, length_m, random);
}

PitCourse PitCourseOf(const GaitOptions& options, double length_m, Random& random) {
  if (!options.pit_m) return {};
  if (options.radius_m == 0) return MakePitCourse(*options.pit_m, length_m, random);
  return MakeCurvedPitCourse(*options.pit_m, length_m, options.radius_m, random);
}

Result<engine::GaitEngine> EngineOf(const GaitOptions& options, const PitCourse& course,
                                    const std::optional<GroundCourse>& ground) {
  if (options.pit_m) return NewEngineOn(course.track, options.surface);
  return ground ? NewEngineOn(ground->track, options.surface) : NewEngine(options.surface);
}

/// Adds what a trial came to.
void AddTrial(const GaitStatistics& statistics, const Walker& walker,
              const engine::EngineOutput& last, double survived_s, Trials& trials) {
  trials.falls += walker.fell() ? 1 : 0;
  trials.survived_s_min = std::min(trials.survived_s_min, survived_s);
  trials.simulated_s += survived_s;
  trials.speed_sum_mps += statistics.speed_mean_mps();
  trials.aside_sum_mps += statistics.aside_mean_mps();
  trials.apex_sum_m += statistics.apex_height_m();
  trials.speed_error.Add(statistics.speed_error_rms_mps());
  trials.heading_error.Add(statistics.heading_error_rms_rad());
  trials.leg_gap_min_m = std::min(trials.leg_gap_min_m, walker.leg_gap_min_m());
  trials.root_force_max_n = std::max(trials.root_force_max_n, last.root_force_max_n);
  trials.state_hash = text::AddFnv(trials.state_hash, last.state_hash);
}

Result<void> RunTrial(const GaitOptions& options, std::uint64_t seed, Trials& trials) {
  Random random(seed);
  const double length_m = options.speed_mps * options.seconds;
  const PitCourse course = PitCourseOf(options, length_m, random);
  const std::optional<GroundCourse> ground =
      options.pit_m ? std::nullopt : GroundCourseOf(options, length_m, random);
  Result<engine::GaitEngine> engine = EngineOf(options, course, ground);
  if (!engine) return engine.error();
  const double push_s = PushTime(options, random);
  const double drawn_deg = random.Uniform(0, 360);
  const bool tows = options.tow.force_n != 0;
  const double tow_s = tows ? kTowFromS + random.Uniform(0, 1) : INFINITY;
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
    if (survived_s >= tow_s) {
      walker.Tow(options.tow.force_n, DegreesToRadians(options.tow.direction_deg));
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
  AddTrial(statistics, walker, engine->Output(), survived_s, trials);
  trials.pits += pilot.met(walker.fell());
  trials.crossed += pilot.crossed();
  if (ground_pilot) trials.steps += ground_pilot->met(walker.fell());
  if (ground_pilot) trials.crossed += ground_pilot->crossed();
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
  if (options.radius_m != 0) report["radius_m"] = options.radius_m;
  if (options.surface.friction != 0) report["friction"] = options.surface.friction;
  if (options.surface.sinks_m != 0) report["soft_m"] = options.surface.sinks_m;
  if (options.tow.force_n != 0) {
    report["tow_n"] = options.tow.force_n;
    report["tow_direction_deg"] = options.tow.direction_deg;
    report["aside_mean_mps"] = trials.aside_sum_mps / options.trials;
  }
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
                        .impulse_ns = options.push_ns,
                        .surface = options.surface};
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
  if (options.radius_m != 0 && !options.pit_m) {
    return cli::Report(UsageError("--radius: goes with --pit; without pits, --turn makes a curve"));
  }
  if (options.pit_m && options.turn_deg != 0) {
    return cli::Report(
        UsageError("--turn: at pits the trial steers along the track; --radius curves it"));
  }
  if (options.tow.force_n != 0 && options.push_directions > 0) {
    return cli::Report(UsageError("--tow: a sweep of pushes has none"));
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
                                                .pit_m = options.pit_m.value_or(0),
                                                .surface = options.surface});
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

namespace {

void AddRoughGround(CLI::App& command, GaitOptions& options) {
  command
      .add_option("--radius", options.radius_m,
                  "Radius of the curves in which the pits lie, m (default: straight)")
      ->check(CLI::Range(5.0, 1000.0));
  command
      .add_option("--friction", options.surface.friction,
                  "Sliding friction of the ground (default: 0.9, the biped's)")
      ->check(CLI::Range(0.05, 2.0));
  command
      .add_option("--soft", options.surface.sinks_m,
                  "How far a foot sinks into the ground under the whole weight, m (default: hard)")
      ->check(CLI::Range(0.0, 0.05));
  command
      .add_option("--tow", options.tow.force_n,
                  "Force that pulls at the body from 2 to 3 s on, N; negative: backwards")
      ->check(CLI::Range(-200.0, 200.0));
  command.add_option("--tow-direction", options.tow.direction_deg,
                     "Direction of the tow, degrees: 0 pulls forwards, 90 to the left");
}

}  // namespace

void AddOptions(CLI::App& command, GaitOptions& options) {
  command.add_option("--gait", options.gait, "Gait: step, walk, run or jump")->required();
  command.add_option("--speed", options.speed_mps, "Commanded speed, m/s")
      ->check(CLI::Range(0.0, 6.0));
  command
      .add_option("--height", options.height_m,
                  "Jump height, m (default: 0.2, or the height that the pit needs)")
      ->check(CLI::Range(0.05, 0.7));
  command.add_option("--turn", options.turn_deg, "Turn, degrees per step; left positive")
      ->check(CLI::Range(-8.0, 8.0));
  command.add_option("--seconds", options.seconds, "Duration of each trial, s")
      ->check(CLI::Range(0.1, 36000.0));
  command.add_option("--trials", options.trials, "Number of trials")->check(CLI::Range(1, 100000));
  command.add_option("--seed", options.seed, "Seed: a number, or random");
  command.add_option("--push", options.push_ns, "Push impulse, N s (default: 2)")
      ->check(CLI::Range(0.0, 1000.0));
  command.add_option(
      "--push-direction", options.push_direction_deg,
      "Push direction, degrees: 0 pushes forwards, 90 to the left (default: random)");
  command
      .add_option("--push-phase", options.push_phase,
                  "Push time as a fraction of the gait cycle, 0 to 1 (default: random)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--slope", options.slope_deg, "Slope of the ground, degrees; uphill positive")
      ->check(CLI::Range(-20.0, 20.0));
  command
      .add_option(
          "--step", options.step_m,
          "Height of the alternating steps of the ground, m; negative: the first step is down")
      ->check(CLI::Range(-0.3, 0.3));
  command
      .add_option(
          "--push-directions", options.push_directions,
          "Number of push directions of a sweep; each is tried at --push-phases times of the cycle")
      ->check(CLI::Range(1, 360));
  command
      .add_option("--push-phases", options.push_phases,
                  "Number of push times per cycle of a sweep (default: 12)")
      ->check(CLI::Range(1, 1000));
  command.add_option("--pit", options.pit_m, "Width of the pits across the track, m")
      ->check(CLI::Range(0.05, 5.0));
  command
      .add_option("--jump-lead", options.jump_lead_s,
                  "Lead of the jump command before a pit, s (run only)")
      ->check(CLI::Range(0.0, 5.0));
  command.add_flag("--no-jump", options.no_jump, "Give a run no jump commands at pits");
  AddRoughGround(command, options);
}

namespace {

constexpr double kWindowS = 1.0;

}  // namespace

double YawOf(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d ahead = q * Eigen::Vector3d::UnitX();
  return std::atan2(ahead.y(), ahead.x());
}

void RootMeanSquare::Add(double value) {
  sum += value * value;
  ++count;
}

double RootMeanSquare::value() const {
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

void GaitStatistics::Add(const engine::EngineOutput& output, double step_s) {
  const double moved_m = output.gait.speed_mps * step_s;
  time_s_ += step_s;
  distance_m_ += moved_m;
  const double heading_rad = output.gait.heading_rad;
  aside_m_ += step_s * (std::cos(heading_rad) * output.v_WC_mps.y() -
                        std::sin(heading_rad) * output.v_WC_mps.x());
  window_s_ += step_s;
  window_m_ += moved_m;
  if (window_s_ >= kWindowS) {
    speed_error_.Add(window_m_ / window_s_ - commanded_mps_);
    window_s_ = window_m_ = 0;
  }
  heading_error_.Add(WrapAngle(YawOf(output.links[0].orientation) - output.gait.heading_rad));
  AddApex(output);
}

void GaitStatistics::AddApex(const engine::EngineOutput& output) {
  const bool flying = !output.contacts[0].touching && !output.contacts[1].touching;
  const double height_m = output.p_WC_m.z();
  const bool lifts_off = flying && !in_flight_;
  const bool lands = !flying && in_flight_;
  if (lifts_off) {
    lift_off_m_ = apex_m_ = height_m;
    flight_known_ = time_s_ > 0.1;
  }
  apex_m_ = std::max(apex_m_, height_m);
  constexpr double kShortestHopM = 0.01;  // Less is a foot that chatters.
  if (lands && flight_known_ && apex_m_ - lift_off_m_ > kShortestHopM) {
    apex_sum_m_ += apex_m_ - lift_off_m_;
    ++hops_;
  }
  in_flight_ = flying;
}

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
  std::array<int, tracking::kTrackings> commands{};  ///< Counted by outcome.

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
