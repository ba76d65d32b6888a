#include "daemon/offline/eval/transitions_command.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/base/json_text.h"
#include "common/base/quantile.h"
#include "daemon/offline/eval/transition_trial.h"
#include "daemon/offline/eval/print_report.h"
#include "daemon/offline/eval/progress.h"

namespace footing::eval {
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
