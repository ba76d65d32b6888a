#include "daemon/offline/eval/tracks.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/units.h"
#include "common/cli/cli.h"
#include "common/runtime/files.h"
#include "common/stream/leg_turn.h"
#include "common/stream/trial.h"
#include "common/virtual/options/sensor_options.h"
#include "daemon/offline/eval/report.h"
#include "daemon/offline/eval/track_trial.h"
#include "daemon/simulation/biped/track.h"

namespace footing::eval {
namespace {

struct TrackOptions {
  std::string interface = "wrist";
  std::string track = "straight";
  int trials = 1;
  std::string seed = "1";
  std::optional<double> grip_deg;
  std::string grip_way = "mirrored";
  users::StyleWish style;
  std::string table;
  std::string turn_by;
  std::string devices = "wiimote";
  std::string start = "stand";
  std::optional<double> seconds;
  std::string trace;
};

const std::map<std::string, HeldKind> kHeldKinds = {
    {"wiimote", HeldKind::kWiimote}, {"joycon", HeldKind::kJoycon}, {"phone", HeldKind::kPhone}};

struct TrackTrials {
  int completed = 0;
  int without_failure = 0;
  stream::FailureCounts failures;
  std::map<std::string, int> tasks;  ///< How often each was drawn.
  std::vector<double> times_s;
  double distance_m = 0, off_track_s = 0;
  Agreement agreement;
  JumpEvents jumps;
  JumpDelays jump_delays;
  RootMeanSquare heading_error, line_heading, off_centre;
};

Result<TrackUser> UserFor(const TrackOptions& options) {
  TrackUser user;
  user.seconds = options.seconds;
  if (options.interface != "direct") {
    user.interface = stream::UserInterfaceNamed(options.interface);
    if (*user.interface == stream::UserInterface::kUnspecified) {
      return UsageError("unknown --interface " + options.interface +
                        "; there are: " + stream::UserInterfaceNames() + ", direct");
    }
  }
  if (!options.turn_by.empty()) {
    user.turn_by = stream::LegTurnSourceNamed(options.turn_by);
    if (user.turn_by == stream::TurnSource::kUnspecified) {
      return UsageError("unknown --turn-by " + options.turn_by + "; there are: head, feet, trunk");
    }
    if (user.interface != stream::UserInterface::kLeg) {
      return UsageError("--turn-by: only the interface leg turns by head, feet or trunk");
    }
  }
  const bool styled = options.style.tempo || options.style.amplitude || options.style.asymmetry;
  if (!user.interface && (styled || !options.table.empty())) {
    return UsageError("--interface direct has neither a body nor a mapping table");
  }
  user.devices = kHeldKinds.at(options.devices);
  const bool no_body = !user.interface || *user.interface == stream::UserInterface::kBoards;
  if (user.devices == HeldKind::kJoycon && no_body) {
    return UsageError("--devices joycon needs --interface wrist, arm, leg or joystick");
  }
  if (user.devices == HeldKind::kPhone &&
      (no_body || *user.interface == stream::UserInterface::kJoystick)) {
    return UsageError("--devices phone needs --interface wrist, arm or leg");
  }
  user.style = options.style;
  user.mapping_table = options.table;
  if (options.grip_deg) {
    const auto grip =
        users::ParseGrip(*options.grip_deg, options.grip_way,
                         user.interface.value_or(stream::UserInterface::kUnspecified));
    if (!grip) return grip.error();
    user.grip = *grip;
  }
  return user;
}

void Pool(const RootMeanSquare& part, RootMeanSquare& all) {
  all.sum += part.sum;
  all.count += part.count;
}

Result<TrackTrials> RunTrials(const TrackOptions& options, const std::string& track, TrackUser user,
                              std::uint64_t seed) {
  Result<TrackTrace> trace = TrackTrace::Create(options.trace);
  if (!trace) return trace.error();
  TrackTrials trials;
  for (int i = 0; i < options.trials; ++i) {
    user.seed = TrialSeed(seed, i);
    user.starts_running = options.start == "run" || (options.start == "half" && i % 2 == 1);
    const Result<TrackResult> run = RunTrack(track, user, *trace);
    if (!run) return run.error();
    if (const auto written = trace->Flush(); !written) return written.error();
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      *stream::MutableCountOf(cause, trials.failures) += stream::CountOf(cause, run->failures);
    }
    if (!run->task.empty()) ++trials.tasks[run->task];
    trials.agreement.Pool(run->agreement);
    trials.jumps.Pool(run->jumps);
    trials.jump_delays.Pool(run->jump_delays);
    trials.distance_m += run->distance_m;
    trials.off_track_s += run->off_track_s;
    Pool(run->heading_error, trials.heading_error);
    Pool(run->line_heading, trials.line_heading);
    Pool(run->off_centre, trials.off_centre);
    std::fprintf(stderr, "trial %d of %d: %s%s%s after %.1f s, failures %d, agreement %.3f\n",
                 i + 1, options.trials, run->task.c_str(), run->task.empty() ? "" : " ",
                 run->completed ? "finished" : "given up", run->time_s,
                 static_cast<int>(stream::Total(run->failures)), run->agreement.share());
    if (!run->completed) continue;
    ++trials.completed;
    if (stream::Total(run->failures) == 0) ++trials.without_failure;
    trials.times_s.push_back(run->time_s);
  }
  std::sort(trials.times_s.begin(), trials.times_s.end());
  return trials;
}

/// Shares of each gait meant; gaits that nobody meant are left out.
nlohmann::ordered_json Confusion(const Agreement::Table& table) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::object();
  for (const stream::Gait meant : stream::kGaits) {
    const auto& row = table[stream::IndexOf(meant)];
    const double sum =
        static_cast<double>(std::accumulate(row.begin(), row.end(), std::uint64_t{0}));
    if (sum == 0) continue;
    for (const stream::Gait commanded : stream::kGaits) {
      rows[stream::Name(meant)][stream::Name(commanded)] =
          static_cast<double>(row[stream::IndexOf(commanded)]) / sum;
    }
  }
  return rows;
}

nlohmann::ordered_json Jumps(const JumpEvents& jumps) {
  return {{"meant", jumps.meant()},         {"recognised", jumps.recognised()},
          {"late", jumps.late()},           {"recall", jumps.recall()},
          {"commanded", jumps.commanded()}, {"not_meant", jumps.not_meant()}};
}

nlohmann::ordered_json MeanAndSpread(const Delay& delay) {
  return {{"count", delay.count}, {"mean_s", delay.mean_s()}, {"sd_s", delay.sd_s()}};
}

nlohmann::ordered_json OrNull(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

nlohmann::ordered_json Report(const TrackOptions& options, std::uint64_t seed,
                              const TrackTrials& trials) {
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
          {"off_centre_rms_m", trials.off_centre.value()},
          {"distance_m", trials.distance_m},
          {"off_track_s", trials.off_track_s},
          {"grip_deg", OrNull(options.grip_deg)},
          {"grip_way", options.grip_deg ? options.grip_way : "drawn"},
          {"turn_by", options.turn_by},
          {"devices", options.devices},
          {"start", options.start},
          {"tempo", OrNull(options.style.tempo)},
          {"amplitude", OrNull(options.style.amplitude)},
          {"asymmetry", OrNull(options.style.asymmetry)},
          {"table", options.table},
          {"gait_agreement", trials.agreement.share()},
          {"gait_confusion", Confusion(trials.agreement.table())},
          {"jumps", Jumps(trials.jumps)},
          {"jump_to_command", MeanAndSpread(trials.jump_delays.to_command())},
          {"jump_to_take_off", MeanAndSpread(trials.jump_delays.to_take_off())}};
}

int Run(const TrackOptions& options, bool json) {
  const Result<TrackUser> user = UserFor(options);
  if (!user) return cli::Report(user.error());
  const Result<std::uint64_t> seed = ParseSeed(options.seed);
  if (!seed) return cli::Report(seed.error());
  const Result<std::string> track = config::ReadNamedOrPath(options.track, "tracks");
  if (!track) return cli::Report(track.error());
  // The engine does not know the file's name.
  const auto parsed = terrain::ParseTrack(*track, options.track);
  if (!parsed) return cli::Report(parsed.error());
  const Result<TrackTrials> trials = RunTrials(options, *track, *user, *seed);
  if (!trials) return cli::Report(trials.error());
  const nlohmann::ordered_json report = Report(options, *seed, *trials);
  PrintReport(report, json);
  return 0;
}

}  // namespace

void AddTracksCommand(CLI::App& app, Shared& shared) {
  CLI::App* command =
      app.add_subcommand("tracks", "Trials of a synthetic user steering along a track");
  auto options = std::make_shared<TrackOptions>();
  command->add_option("--interface", options->interface,
                      "Interface: wrist, arm, leg, joystick, boards, or direct (default wrist)");
  command->add_option("--track", options->track,
                      "Track: straight, 1 to 4 or another built-in name, or a JSON file");
  command->add_option("--trials", options->trials, "Number of trials")
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->seed, "Seed: a number, or random");
  auto* grip = command->add_option(
      "--grip-deg", options->grip_deg,
      "Rotation of the remotes in the hands, degrees (default: drawn for each user)");
  command
      ->add_option("--grip-way", options->grip_way,
                   "Grips of both hands: mirrored or same (default mirrored)")
      ->needs(grip);
  sensor_options::AddUserStyle(*command, options->style);
  command->add_option("--table", options->table,
                      "Mapping table of the interface, JSON file (default: the built-in one)");
  command->add_option(
      "--turn-by", options->turn_by,
      "Body part that steers with the interface leg: head, feet or trunk (default head)");
  command
      ->add_option("--devices", options->devices,
                   "Devices that the user holds: wiimote, joycon or phone (default wiimote)")
      ->check(CLI::IsMember(kHeldKinds));
  command
      ->add_option("--seconds", options->seconds,
                   "Duration of a trial, s (default: to the finish line, at most 600)")
      ->check(CLI::Range(1.0, 1e5));
  command
      ->add_option(
          "--start", options->start,
          "How users begin: stand (default), run (in mid-run), or half: every second one runs")
      ->check(CLI::IsMember({"stand", "run", "half"}));
  command->add_option("--trace", options->trace,
                      "CSV file to write: what user, interface and character do, every 10 ms");
  command->callback([options, &shared] { shared.exit_code = Run(*options, shared.json); });
}

namespace {

constexpr const char* kSurface = "#cfa791";
constexpr const char* kUphill = "#b9c98d";
constexpr const char* kDownhill = "#9db7d6";
constexpr const char* kPit = "#1b1b1f";
constexpr const char* kStep = "#8a4fa0";
constexpr const char* kStartLine = "#3d8b37";
constexpr const char* kMarkLine = "#e09a00";
constexpr const char* kFinishLine = "#c0202a";
/// Length of a track that is drawn, from its beginning, m.
constexpr double kMostDrawnM = 120;

using Corner = std::array<double, 2>;

Corner CornerAt(const stream::TrackSegment& segment, double along_m, double left_m) {
  const double c = std::cos(segment.heading_rad), s = std::sin(segment.heading_rad);
  const double level_m = along_m * std::cos(segment.slope_rad);
  return {segment.start_m.x() + level_m * c - left_m * s,
          segment.start_m.y() + level_m * s + left_m * c};
}

/// Along offset of a segment's end, over sideways, where it meets its neighbour in the middle of
/// their turn.
double HalfTurn(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  return std::tan(WrapAngle(far.heading_rad - near.heading_rad) / 2);
}

const char* ColourOf(const stream::TrackSegment& segment) {
  if (segment.pit) return kPit;
  if (segment.slope_rad > 0) return kUphill;
  return segment.slope_rad < 0 ? kDownhill : kSurface;
}

plot::PlanShape AreaOf(const stream::Track& track, std::size_t i) {
  const stream::TrackSegment& segment = track.segments[i];
  const double half_m = segment.width_m / 2;
  const double length_m = std::min(segment.length_m, kMostDrawnM);
  const double start = i > 0 ? HalfTurn(track.segments[i - 1], segment) : 0;
  const bool last = i + 1 == track.segments.size();
  const double end = last ? 0 : -HalfTurn(segment, track.segments[i + 1]);
  return {{CornerAt(segment, -half_m * start, -half_m),
           CornerAt(segment, length_m - half_m * end, -half_m),
           CornerAt(segment, length_m + half_m * end, half_m),
           CornerAt(segment, half_m * start, half_m)},
          ColourOf(segment)};
}

void AddLine(const stream::Track& track, double at_m, const char* colour, plot::PlanPanel& panel) {
  double from_m = 0;
  for (const stream::TrackSegment& segment : track.segments) {
    if (at_m >= from_m && at_m < from_m + segment.length_m) {
      const double half_m = segment.width_m / 2;
      panel.shapes.push_back(
          {{CornerAt(segment, at_m - from_m, -half_m), CornerAt(segment, at_m - from_m, half_m)},
           colour});
      return;
    }
    from_m += segment.length_m;
  }
}

}  // namespace

plot::PlanPanel PlanOf(const std::string& name, const stream::Track& track) {
  plot::PlanPanel panel{name, {}};
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    panel.shapes.push_back(AreaOf(track, i));
  }
  double from_m = 0;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const bool step =
        i > 0 && std::fabs(track.segments[i].start_m.z() -
                           stream::Following(track.segments[i - 1]).start_m.z()) > 1e-6;
    if (step) AddLine(track, from_m, kStep, panel);
    from_m += track.segments[i].length_m;
  }
  if (track.finish_m > 0) {
    AddLine(track, track.start_m, kStartLine, panel);
    AddLine(track, track.finish_m, kFinishLine, panel);
  }
  if (track.mark_m > 0) AddLine(track, track.mark_m, kMarkLine, panel);
  return panel;
}

std::vector<plot::PlanKey> PlanKeys() {
  return {{kStartLine, "start"}, {kFinishLine, "finish"}, {kMarkLine, "mark"}, {kPit, "pit"},
          {kUphill, "uphill"},   {kDownhill, "downhill"}, {kStep, "step"}};
}

namespace {

struct PlanOptions {
  std::vector<std::string> tracks;
  std::string out;
};

int DrawPlan(const PlanOptions& options, bool json) {
  std::vector<plot::PlanPanel> panels;
  for (const std::string& name : options.tracks) {
    const auto text = config::ReadNamedOrPath(name, "tracks");
    if (!text) return cli::Report(text.error());
    const auto track = terrain::ParseTrack(*text, name);
    if (!track) return cli::Report(track.error());
    panels.push_back(PlanOf(name, *track));
  }
  std::ofstream file(options.out);
  file << plot::PlanPlot("Tracks from above", panels, PlanKeys());
  if (!file.flush()) {
    return cli::Report(Failure("cannot write " + options.out + ": " +
                               std::generic_category().message(errno) + "; name another file"));
  }
  PrintReport({{"out", options.out}, {"tracks", options.tracks}}, json);
  return 0;
}

}  // namespace

void AddPlanCommand(CLI::App& app, Shared& shared) {
  CLI::App* command = app.add_subcommand("plan", "Plan view of tracks, as SVG");
  auto options = std::make_shared<PlanOptions>();
  command->add_option("TRACK", options->tracks, "Built-in names, or JSON files")->required();
  command->add_option("--out", options->out, "SVG file to write")->required();
  command->callback([options, &shared] { shared.exit_code = DrawPlan(*options, shared.json); });
}

}  // namespace footing::eval
