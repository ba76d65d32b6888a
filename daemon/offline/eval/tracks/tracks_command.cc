#include "daemon/offline/eval/tracks/tracks_command.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/cli/cli.h"
#include "common/config/data_file.h"
#include "daemon/offline/eval/report/print_report.h"
#include "daemon/offline/eval/tracks/track_trial.h"

namespace footing::eval {
namespace {

struct Options {
  std::string interface = "wrist";
  std::string track = "straight";
  int trials = 1;
  std::string seed = "1";
};

struct Trials {
  int completed = 0;
  int without_failure = 0;
  stream::FailureCounts failures;
  std::map<std::string, int> tasks;  ///< How often each was drawn.
  std::vector<double> times_s;
  RootMeanSquare heading_error, line_heading, off_centre;
};

Result<Interface> InterfaceNamed(const std::string& name) {
  if (name == "wrist") return Interface::kWrist;
  if (name == "direct") return Interface::kDirect;
  return UsageError("--interface " + name + " is not built; there is: wrist, direct");
}

void Pool(const RootMeanSquare& part, RootMeanSquare& all) {
  all.sum += part.sum;
  all.count += part.count;
}

Result<Trials> RunTrials(const Options& options, const std::string& track, Interface interface,
                         std::uint64_t seed) {
  Trials trials;
  for (int i = 0; i < options.trials; ++i) {
    const Result<TrackResult> run = RunTrack(track, interface, TrialSeed(seed, i));
    if (!run) return run.error();
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      *stream::MutableCountOf(cause, trials.failures) += stream::CountOf(cause, run->failures);
    }
    if (!run->task.empty()) ++trials.tasks[run->task];
    Pool(run->heading_error, trials.heading_error);
    Pool(run->line_heading, trials.line_heading);
    Pool(run->off_centre, trials.off_centre);
    std::fprintf(stderr, "trial %d of %d: %s%s%s after %.1f s, failures %d\n", i + 1,
                 options.trials, run->task.c_str(), run->task.empty() ? "" : " ",
                 run->completed ? "finished" : "given up", run->time_s,
                 static_cast<int>(stream::Total(run->failures)));
    if (!run->completed) continue;
    ++trials.completed;
    if (stream::Total(run->failures) == 0) ++trials.without_failure;
    trials.times_s.push_back(run->time_s);
  }
  std::sort(trials.times_s.begin(), trials.times_s.end());
  return trials;
}

nlohmann::ordered_json Report(const Options& options, std::uint64_t seed, const Trials& trials) {
  const auto& times_s = trials.times_s;
  nlohmann::ordered_json failures;
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    failures[stream::Name(cause)] = stream::CountOf(cause, trials.failures);
  }
  return {{"interface", options.interface},
          {"track", options.track},
          {"seed", seed},
          {"trials", options.trials},
          {"completed", trials.completed},
          {"completed_without_failure", trials.without_failure},
          {"failures", failures},
          {"tasks", trials.tasks},
          {"median_time_s", times_s.empty() ? 0 : times_s[times_s.size() / 2]},
          {"heading_error_rms_rad", trials.heading_error.value()},
          {"line_heading_rms_rad", trials.line_heading.value()},
          {"off_centre_rms_m", trials.off_centre.value()}};
}

int Run(const Options& options, bool json) {
  const Result<Interface> interface = InterfaceNamed(options.interface);
  if (!interface) return cli::Report(interface.error());
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  const Result<std::string> track = config::ReadNamedOrPath(options.track, "tracks");
  if (!track) return cli::Report(track.error());
  const Result<Trials> trials = RunTrials(options, *track, *interface, *seed);
  if (!trials) return cli::Report(trials.error());
  const nlohmann::ordered_json report = Report(options, *seed, *trials);
  PrintReport(report, json);
  return 0;
}

}  // namespace

void AddTracksCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("tracks", "Trials of a synthetic user steering along a track");
  auto options = std::make_shared<Options>();
  command->add_option("--interface", options->interface, "Interface: wrist or direct");
  command->add_option("--track", options->track,
                      "Track: straight, 1 to 4 or another built-in name, or a JSON file");
  command->add_option("--trials", options->trials, "Number of trials")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->seed, "Seed: a number, or random");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared.json); });
}

}  // namespace footing::eval
