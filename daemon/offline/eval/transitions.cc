#include "daemon/offline/eval/transitions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "daemon/offline/eval/report.h"
#include "daemon/simulation/gait/gain_table.h"

namespace footing::eval {
namespace {

using stream::Gait;

constexpr double kKickTimeS = 1.5;
constexpr double kTransitionKickNs = 2;
constexpr double kLatestReachS = 10;
constexpr double kTransitionUprightS = 5;
constexpr double kTransitionSettleS =
    4;  ///< Beyond the upright time, for the slew of the speed command.
constexpr double kSpeedToleranceMps = 0.1;

const char* const kTouchdownPhase = gait::Name(gait::RunningPhase::kCompression);

/// Mean speed over one whole second, a second after the next.
class SpeedPerSecond {
 public:
  void Add(double speed_mps, double step_s) {
    sum_m_ += speed_mps * step_s;
    time_s_ += step_s;
    if (time_s_ < 1) return;
    last_mps_ = sum_m_ / time_s_;
    sum_m_ = time_s_ = 0;
  }
  double last_mps() const { return last_mps_; }

 private:
  double sum_m_ = 0, time_s_ = 0, last_mps_ = 0;
};

/// Follows the first flight of jumping.
class LeapMeter {
 public:
  void Add(const engine::EngineOutput& output) {
    if (leap_ || (!flies_ && output.gait.gait != Gait::kJump)) return;
    if (!flies_) {
      flies_ = true;
      start_s_ = output.time_s;
      start_W_m_ = output.p_WC_m;
    }
    rise_m_ = std::max(rise_m_, output.p_WC_m.z() - start_W_m_.z());
    if (output.gait.phase != std::string_view(kTouchdownPhase)) return;
    leap_ = Leap{.flight_s = output.time_s - start_s_,
                 .length_m = (output.p_WC_m - start_W_m_).head<2>().norm(),
                 .rise_m = rise_m_,
                 .commanded_m = output.gait.commanded_height_m};
  }
  const std::optional<Leap>& leap() const { return leap_; }

 private:
  bool flies_ = false;
  double start_s_ = 0, rise_m_ = 0;
  Eigen::Vector3d start_W_m_ = Eigen::Vector3d::Zero();
  std::optional<Leap> leap_;
};

}  // namespace

biped::GaitCommand DrawCommand(Gait gait, Random& random) {
  biped::GaitCommand command;
  command.gait = gait;
  command.height_m = random.Uniform(0.1, 0.35);
  switch (gait) {
    case Gait::kWalk:
      command.speed_mps = random.Uniform(0.2, 1.4);
      break;
    case Gait::kRun:
      command.speed_mps = random.Uniform(1.5, 4.5);
      break;
    case Gait::kJump:
      command.speed_mps = random.Uniform(0, 1);
      break;
    case Gait::kStep:
    case Gait::kUnspecified:
      break;
  }
  return command;
}

Result<TransitionResult> RunTransition(Gait from, Gait to, std::uint64_t seed,
                                       const TransitionSpeeds& speeds) {
  Result<engine::GaitEngine> engine = NewEngine();
  if (!engine) return engine.error();
  Random random(seed);
  biped::GaitCommand before = DrawCommand(from, random);
  biped::GaitCommand after = DrawCommand(to, random);
  before.speed_mps = speeds.from_mps.value_or(before.speed_mps);
  after.speed_mps = speeds.to_mps.value_or(after.speed_mps);
  after.height_m = speeds.height_m.value_or(after.height_m);
  const double change_s = random.Uniform(7, 8.5);
  const double kick_rad = random.Uniform(-kPi, kPi);
  const double step_s = engine::EngineConfig{}.step_s;

  Walker walker(*engine);
  TransitionResult result;
  SpeedPerSecond speed;
  LeapMeter meter;
  double reached_s = -1;
  bool kicked = false, changed = false;
  for (double time_s = 0; !walker.fell();) {
    if (!kicked && time_s >= kKickTimeS) walker.Push(kTransitionKickNs, kick_rad);
    kicked = kicked || time_s >= kKickTimeS;
    changed = time_s >= change_s;
    walker.Command(changed ? after : before);
    const engine::EngineOutput& output = walker.Advance();
    time_s = output.time_s;
    speed.Add(output.gait.speed_mps, step_s);
    if (changed && to == Gait::kJump) meter.Add(output);
    if (changed && reached_s < 0 && output.gait.gait == to) reached_s = time_s;
    if (reached_s < 0 && time_s > change_s + kLatestReachS) break;
    const bool stayed = reached_s >= 0 && time_s > reached_s + kTransitionUprightS;
    result.succeeded = stayed && output.gait.gait == to &&
                       std::fabs(speed.last_mps() - after.speed_mps) <= kSpeedToleranceMps;
    if (result.succeeded ||
        (stayed && time_s > reached_s + kTransitionUprightS + kTransitionSettleS))
      break;
  }
  result.leap = meter.leap();
  result.fell = walker.fell();
  result.succeeded = result.succeeded && !result.fell;
  if (reached_s >= 0) result.latency_s = reached_s - change_s;
  return result;
}

namespace {

struct TransitionOptions {
  std::string from;
  std::string to;
  int trials = 10;
  std::string seed = "1";
  TransitionSpeeds speeds;
};

/// The value of the rank nearest to this part of the way from the least to the greatest; 0 of none.
double NearestQuantile(const std::vector<double>& values, double part) {
  if (values.empty()) return 0;
  const auto last = static_cast<double>(values.size() - 1);
  return text::OfRank(values, static_cast<std::size_t>(part * last + 0.5));
}

/// The first leaps of jumps.
class Leaps {
 public:
  void Add(const Leap& leap) {
    flights_s_.push_back(leap.flight_s);
    lengths_m_.push_back(leap.length_m);
    rise_shares_.push_back(leap.rise_m / leap.commanded_m);
  }

  nlohmann::ordered_json Report() const {
    return {{"leaps", flights_s_.size()},
            {"flight_s", Quantiles(flights_s_)},
            {"length_m", Quantiles(lengths_m_)},
            {"rise_over_commanded", Quantiles(rise_shares_)}};
  }

 private:
  static nlohmann::ordered_json Quantiles(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {{"p5", NearestQuantile(values, 0.05)},
            {"median", NearestQuantile(values, 0.5)},
            {"p95", NearestQuantile(values, 0.95)}};
  }

  std::vector<double> flights_s_, lengths_m_, rise_shares_;
};

int RunTransitions(const TransitionOptions& options, bool json) {
  const stream::Gait from = stream::GaitNamed(options.from);
  const stream::Gait to = stream::GaitNamed(options.to);
  if (from == stream::Gait::kUnspecified || to == stream::Gait::kUnspecified || from == to) {
    return cli::Report(UsageError("--from " + options.from + " --to " + options.to +
                                  ": must be two different gaits of " + stream::GaitNames()));
  }
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  int succeeded = 0, falls = 0;
  std::vector<double> latencies_s;
  Leaps leaps;
  Progress progress("transitions", "trials", options.trials, clock::MonotonicNs());
  for (int i = 0; i < options.trials; ++i) {
    progress.Done(i, clock::MonotonicNs(), std::cerr);
    const Result<TransitionResult> trial =
        RunTransition(from, to, TrialSeed(*seed, i), options.speeds);
    if (!trial) return cli::Report(trial.error());
    falls += trial.value().fell ? 1 : 0;
    if (trial.value().leap) leaps.Add(*trial.value().leap);
    if (!trial.value().succeeded) continue;
    ++succeeded;
    latencies_s.push_back(trial.value().latency_s);
  }
  std::sort(latencies_s.begin(), latencies_s.end());
  nlohmann::ordered_json report{{"from", options.from},
                                {"to", options.to},
                                {"seed", *seed},
                                {"trials", options.trials},
                                {"succeeded", succeeded},
                                {"falls", falls},
                                {"median_latency_s", NearestQuantile(latencies_s, 0.5)},
                                {"p95_latency_s", NearestQuantile(latencies_s, 0.95)}};
  if (to == stream::Gait::kJump) report["leap"] = leaps.Report();
  if (json) {
    std::printf("%s\n", text::ToText(report).c_str());
  } else {
    std::printf("%s -> %s: %d of %d succeeded, %d falls, latency median %.2f s, p95 %.2f s\n",
                options.from.c_str(), options.to.c_str(), succeeded, options.trials, falls,
                NearestQuantile(latencies_s, 0.5), NearestQuantile(latencies_s, 0.95));
  }
  return 0;
}

}  // namespace

void AddTransitionsCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("transitions", "Trials of a transition from one gait to another");
  auto options = std::make_shared<TransitionOptions>();
  command->add_option("--from", options->from, "Initial gait: step, walk, run or jump")->required();
  command->add_option("--to", options->to, "Final gait: step, walk, run or jump")->required();
  command->add_option("--trials", options->trials, "Number of trials")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->seed, "Seed: a number, or random");
  command
      ->add_option("--from-speed", options->speeds.from_mps, "Initial speed, m/s (default: drawn)")
      ->check(CLI::Range(0.0, 6.0));
  command->add_option("--to-speed", options->speeds.to_mps, "Final speed, m/s (default: drawn)")
      ->check(CLI::Range(0.0, 6.0));
  command->add_option("--height", options->speeds.height_m, "Jump height, m (default: drawn)")
      ->check(CLI::Range(0.05, 0.7));
  command->footer(
      "Examples:\n"
      "  footing-eval transitions --from walk --to run --trials 20 --seed 1 --json\n"
      "  footing-eval transitions --from walk --to run --trials 20 --gains walk.csv");
  command->callback(
      [options, &shared] { shared.exit_code = RunTransitions(*options, shared.json); });
}

}  // namespace footing::eval
