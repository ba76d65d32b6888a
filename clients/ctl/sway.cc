#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

#include <unistd.h>

#include "clients/ctl/commands.h"
#include "clients/ctl/guided.h"
#include "clients/ctl/report/sway_report.h"
#include "clients/ctl/report/sway_trial.h"
#include "common/base/json_text.h"
#include "common/base/text.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/recording/recorded_session.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/clock.h"
#include "common/runtime/files.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

using sway::TrialGuide;

constexpr double kSwayStepS = 0.05;
constexpr double kSwaySilenceS = 3;  // Without a tick in this time, footingd is gone.
constexpr const char* kPlanRecord = "sway";
constexpr const char* kTrialRecord = "sway_trial";

struct SwayOptions {
  std::string subject = "subject";
  std::string notes;
  std::vector<std::string> eyes = sway::kEyes;
  std::vector<std::string> surfaces = {"firm"};
  std::vector<std::string> feet = {"shoulder"};
  int repeats = 3;
  double seconds = 30;
  double settle_s = 5;
  int attempts = 3;
  double wait_s = 600;
  posturography::CopFilterOptions filter;
  std::string rig = "main";
  std::string out;
  std::string from;
  bool replace = false;
  bool script = false;
};

/// Files of a session beside its recording.
struct OutputFiles {
  std::string recording, csv, cop, report;

  explicit OutputFiles(const std::string& base)
      : recording(base + ".mcap"),
        csv(base + ".csv"),
        cop(base + "_cop.csv"),
        report(base + ".html") {}

  Result<void> CheckCreatable(bool replace) const {
    for (const std::string* path : {&csv, &cop, &report}) {
      if (const auto good = recording::CheckCreatable(*path, replace); !good) return good.error();
    }
    return {};
  }
  Result<void> Write(const sway::Session& session) const {
    const std::pair<const std::string&, std::string> files[] = {{csv, sway::ToCsv(session)},
                                                                {cop, sway::CopToCsv(session)},
                                                                {report, sway::ToHtml(session)}};
    for (const auto& [path, content] : files) {
      if (const auto done = config::ReplaceFile(path, content); !done) {
        return Failure("cannot write " + path + ": " + done.error().message);
      }
    }
    return {};
  }
};

/// PATH of PATH.mcap.
std::string WithoutEnding(const std::string& path) {
  const std::string ending = ".mcap";
  return path.ends_with(ending) ? path.substr(0, path.size() - ending.size()) : path;
}

/// Boards of the rig, the left one first, with their places in W.
Result<std::vector<sway::Board>> BoardsOf(const Connection& session, const std::string& rig) {
  stream::BoardLayout layout;
  for (const auto& one : session.setup()) {
    if (one.rig == rig) layout = one.layout;
  }
  layout = board::LayoutOr(layout);
  std::vector<sway::Board> boards;
  for (const auto& device : DevicesOf(session, rig)) {
    if (device.kind != stream::DeviceKind::kBalanceBoard) continue;
    const bool right = device.role == stream::DeviceRole::kRightBoard;
    boards.push_back({device.serial, device.role, right ? layout.right : layout.left,
                      board::GeometryOr(right ? layout.right_geometry : layout.left_geometry)});
    if (!device.tared) {
      std::cerr << "warning: the " << sway::Name(boards.back())
                << " is not tared; step off, then: footing-ctl tare all" << std::endl;
    }
  }
  for (const auto& device : session.status()) {
    if (device.kind == stream::DeviceKind::kBalanceBoard && device.rig == rig &&
        device.state == stream::DeviceState::kLost && !boards.empty()) {
      std::cerr << "warning: board " << device.serial
                << " is lost and not used; if the subject stands on it, press its button and "
                   "start again"
                << std::endl;
    }
  }
  if (boards.empty()) {
    return NoDevice("rig " + rig +
                    " has no board: press its button, or pair it (footing-ctl pair board); see "
                    "footing-ctl devices");
  }
  if (boards.size() > 2) {
    return UsageError("rig " + rig + " has " + std::to_string(boards.size()) +
                      " boards; sway takes one or two: switch the others off");
  }
  if (boards.size() == 1) {
    boards[0].pose = {};
    return boards;
  }
  if (std::string problem = board::ProblemWith(layout, boards.size(), rig); !problem.empty()) {
    return Failure(std::move(problem));
  }
  if (boards[0].role == stream::DeviceRole::kRightBoard) std::swap(boards[0], boards[1]);
  if (boards[0].role != stream::DeviceRole::kLeftBoard ||
      boards[1].role != stream::DeviceRole::kRightBoard) {
    return Failure("rig " + rig +
                   " has two boards that are not left_board and right_board: run footing-ctl "
                   "assign --gesture");
  }
  return boards;
}

/// Trials in their order. Surface and feet change least often: both take time.
std::vector<sway::Trial> PlanOf(const SwayOptions& options) {
  std::vector<sway::Trial> plan;
  for (const std::string& surface : options.surfaces) {
    for (const std::string& feet : options.feet) {
      for (const std::string& eyes : options.eyes) {
        for (int repeat = 1; repeat <= options.repeats; ++repeat) {
          sway::Trial& trial = plan.emplace_back();
          trial.condition = {eyes, surface, feet};
          trial.repeat = repeat;
        }
      }
    }
  }
  return plan;
}

/// "sway open firm shoulder 2": the trial between a pair of markers.
std::string MarkerName(const sway::Trial& trial) {
  const sway::Condition& c = trial.condition;
  return "sway " + c.eyes + " " + c.surface + " " + c.feet + " " + std::to_string(trial.repeat);
}

/// The samples of the session's boards out of the ticks of footingd.
class Samples {
 public:
  explicit Samples(const std::vector<sway::Board>& boards) : boards_(boards) { Clear(); }

  void Clear() { tracks_.assign(boards_.size(), {}); }
  void Take(const std::vector<stream::BoardSample>& samples,
            const std::vector<stream::DeviceStatus>& devices) {
    for (const stream::BoardSample& sample : samples) {
      const auto device = std::find_if(devices.begin(), devices.end(), [&](const auto& one) {
        return one.device == sample.device;
      });
      if (device == devices.end()) continue;
      for (std::size_t i = 0; i < boards_.size(); ++i) {
        if (boards_[i].serial == device->serial) tracks_[i].push_back(sample);
      }
    }
  }
  const sway::Tracks& tracks() const { return tracks_; }
  /// The newest sample of each board, kept over Clear().
  const std::vector<sway::BoardNow>& Now() {
    now_.resize(boards_.size());
    for (std::size_t i = 0; i < boards_.size(); ++i) {
      if (!tracks_[i].empty()) now_[i] = {tracks_[i].back().sampled_ns, tracks_[i].back().total_n};
    }
    return now_;
  }

 private:
  const std::vector<sway::Board>& boards_;
  sway::Tracks tracks_;
  std::vector<sway::BoardNow> now_;
};

/// A session with a person, step by step, recorded from its first tick on.
class LiveSway {
 public:
  LiveSway(Connection& connection, const SwayOptions& options, sway::Session& session,
           recording::RecordingWriter writer)
      : connection_(connection),
        options_(options),
        session_(session),
        files_(WithoutEnding(session.recording)),
        writer_(std::move(writer)),
        recorder_(writer_, "footingd", [](const std::string& id) { return id; }),
        samples_(session.boards),
        on_terminal_(!options.script && isatty(STDIN_FILENO) == 1),
        on_screen_(!options.script && isatty(STDERR_FILENO) == 1) {}

  /// Everything that was measured is in the files, however it ends.
  Result<void> Go() {
    Keep(writer_.AddMetadata(kPlanRecord, {{"plan", text::ToText(sway::PlanToJson(session_))}}));
    connection_.set_on_tick(
        [this](const v1::Tick& tick, const rig::Tick& sensors) { Take(tick, sensors); });
    for (sway::Trial trial : PlanOf(options_)) {
      for (; trial.attempt <= options_.attempts && kept_; ++trial.attempt) {
        if (Attempt(trial)) break;
      }
    }
    connection_.RunFor(2 * kSwayStepS);  // The ticks with the last markers.
    connection_.set_on_tick({});
    Keep(recorder_.OnEnd({}, clock::MonotonicNs()));
    Keep(writer_.Finish());
    return kept_;
  }

 private:
  /// Returns whether it counts.
  bool Attempt(const sway::Trial& planned) {
    sway::Trial trial = planned;
    Say("\n> ", "PROMPT: ",
        sway::Title(trial.condition) + ", trial " + std::to_string(trial.repeat) + " of " +
            std::to_string(options_.repeats) + (trial.attempt > 1 ? ", again" : ""));
    guide_.emplace(TrialGuide::Settings{options_.settle_s, options_.seconds, on_terminal_},
                   session_.boards, trial.condition);
    Lead(trial);
    trial.from_ns = guide_->from_ns();
    if (guide_->phase() == TrialGuide::Phase::kWaiting || trial.from_ns == 0) return false;
    trial.rejected = guide_->rejected();
    trial.to_ns = trial.rejected.empty() ? guide_->to_ns() : connection_.server_ns();
    if (trial.rejected.empty()) {
      sway::MeasureTrial(session_.boards, samples_.tracks(), session_.filter, trial);
    }
    Mark("end " + MarkerName(trial), trial.to_ns);
    const bool counts = trial.rejected.empty();
    if (!counts) Mark("rejected " + MarkerName(trial) + ": " + trial.rejected, trial.to_ns);
    Say(counts ? "  " : "  rejected: ", counts ? "DONE: " : "REJECTED: ",
        counts ? "path " + text::Fixed(trial.measures->path_m * 1e3, 0) + " mm, 95 % ellipse " +
                     text::Fixed(trial.measures->ellipse95_prediction_m2 * 1e6, 0) + " mm2"
               : trial.rejected);
    if (on_screen_) std::cerr << '\a' << std::flush;
    Keep(writer_.AddMetadata(kTrialRecord, {{"trial", text::ToText(sway::TrialToJson(trial))}}));
    Keep(writer_.Flush());
    session_.trials.push_back(std::move(trial));
    Keep(files_.Write(session_));
    return counts;
  }

  /// Until the attempt under way has ended, or nothing more can be done (`kept_`).
  void Lead(const sway::Trial& trial) {
    std::string prompt;
    double waited_s = 0, silent_s = 0;
    std::int64_t last_ns = connection_.server_ns();
    bool marked = false;
    const auto ended = [this] {
      return guide_->phase() == TrialGuide::Phase::kDone ||
             guide_->phase() == TrialGuide::Phase::kRejected;
    };
    while (kept_ && !ended()) {
      start_ = start_ || (on_terminal_ && EnterPressed());
      if (connection_.RunFor(kSwayStepS) == Waited::kInterrupted) {
        guide_->Interrupt("stopped by the operator");
        Keep(Failure("stopped; what was measured until then is in " + session_.recording));
      }
      silent_s = connection_.server_ns() == last_ns ? silent_s + kSwayStepS : 0;
      last_ns = connection_.server_ns();
      if (silent_s > kSwaySilenceS) guide_->Interrupt("footingd is gone: " + connection_.link());
      const bool waiting = guide_->phase() == TrialGuide::Phase::kWaiting;
      waited_s = waiting ? waited_s + kSwayStepS : 0;
      if (waited_s > options_.wait_s) {
        Keep(NoDevice("gave up after " + text::Shortest(options_.wait_s) +
                      " s: " + guide_->prompt() + " What was measured until then is in " +
                      session_.recording));
      }
      if (guide_->phase() == TrialGuide::Phase::kMeasuring && !marked) {
        marked = true;
        Mark("begin " + MarkerName(trial), guide_->from_ns());
      }
      if (guide_->prompt() != prompt) {
        prompt = guide_->prompt();
        Say("> ", "PROMPT: ", prompt);
      }
      ShowProgress();
      Keep(writer_.Flush());
    }
  }

  /// At the ticks, so that a trial begins and ends at times of footingd's clock.
  void Take(const v1::Tick& tick, const rig::Tick& sensors) {
    const std::int64_t now_ns = clock::MonotonicNs();
    if (sensors.epoch != epoch_) {  // The first tick, or that of a restarted footingd.
      epoch_ = sensors.epoch;
      Keep(recorder_.OnWelcome(connection_.welcome(), now_ns));
    }
    Keep(recorder_.OnTick(tick, now_ns));
    if (!guide_) return;
    if (guide_->phase() == TrialGuide::Phase::kWaiting) samples_.Clear();
    samples_.Take(sensors.boards, connection_.status());
    if (!sensors.snapshot && !sensors.refilled) {
      guide_->Advance(sensors.host_ns, samples_.Now(), std::exchange(start_, false));
    }
  }

  /// For whoever records footingd, too. Without the right to mark, the recording's own records say
  /// as much.
  void Mark(const std::string& marker, std::int64_t host_ns) {
    if (!may_mark_) return;
    v1::Command command;
    command.mutable_marker()->set_text(marker);
    command.mutable_marker()->set_host_ns(host_ns);
    may_mark_ = connection_.Call(std::move(command)).ok();
  }

  void Say(const std::string& to_person, const std::string& to_script, const std::string& what) {
    if (dirty_) std::cerr << std::endl;
    dirty_ = false;
    std::cerr << (options_.script ? to_script : to_person) << what << std::endl;
  }

  /// Load, its share on the left board and the time that is left, in place.
  void ShowProgress() {
    if (!on_screen_) return;
    double total_n = 0;
    const auto& now = samples_.Now();
    for (const sway::BoardNow& one : now) total_n += one.load_n;
    std::string line = text::Fixed(NewtonsToKilograms(total_n), 1) + " kg";
    if (now.size() == 2 && total_n > board::kContactOffN) {
      line += ", " + text::Fixed(100 * now[0].load_n / total_n, 0) + " % left";
    }
    if (guide_->left_s() > 0) {
      line += std::string(guide_->phase() == TrialGuide::Phase::kSettling ? ", begins in "
                                                                          : ", still ") +
              text::Fixed(guide_->left_s(), 0) + " s";
    }
    std::cerr << "\r\x1b[K  " << line << std::flush;
    dirty_ = true;
  }

  void Keep(Result<void> done) {
    if (!done && kept_) kept_ = std::move(done);
  }

  Connection& connection_;
  const SwayOptions& options_;
  sway::Session& session_;
  OutputFiles files_;
  recording::RecordingWriter writer_;
  recording::StreamRecorder recorder_;
  Samples samples_;
  std::optional<TrialGuide> guide_;
  const bool on_terminal_, on_screen_;
  bool start_ = false;
  bool may_mark_ = true;
  bool dirty_ = false;
  std::uint64_t epoch_ = 0;
  Result<void> kept_;
};

Result<void> Show(const sway::Session& session, const std::optional<OutputFiles>& files,
                  const Shared& shared) {
  nlohmann::ordered_json out = sway::ToJson(session);
  std::string text = sway::ToText(session);
  if (files) {
    out["files"] = {{"report", files->report}, {"csv", files->csv}, {"cop", files->cop}};
    text += "\nreport: " + files->report + "\nmeasures: " + files->csv + "\nCOP: " + files->cop +
            "\nrecording: " + session.recording;
  }
  Print(out, text, shared);
  if (const std::size_t missing = sway::Missing(session); missing > 0) {
    return Failure(std::to_string(missing) + " of " + std::to_string(session.planned) +
                   " trials are missing; the reasons are in the answer");
  }
  return {};
}

Result<void> RunSway(Connection& connection, const SwayOptions& options,
                     const posturography::CopFilter& filter, const Shared& shared) {
  sway::Session session;
  auto boards = BoardsOf(connection, options.rig);
  if (!boards) return boards.error();
  if (boards->size() > 1 && filter.rate_hz <= 0) {
    return UsageError("--rate-hz recorded: two boards sample at times of their own; give a rate");
  }
  session.subject = options.subject;
  session.notes = options.notes;
  session.wall_time_ns = clock::WallNs();
  session.boards = std::move(*boards);
  session.seconds = options.seconds;
  session.settle_s = options.settle_s;
  session.filter = filter;
  session.planned = PlanOf(options).size();
  session.program = std::string("footing-ctl ") + cli::Version();
  const OutputFiles files(WithoutEnding(options.out.empty() ? "sway" : options.out));
  session.recording = files.recording;
  if (const auto good = files.CheckCreatable(options.replace); !good) return good.error();
  auto writer = CreateRecording(files.recording, options.replace);
  if (!writer) return writer.error();
  const auto done = LiveSway(connection, options, session, std::move(*writer)).Go();
  if (session.trials.empty() && !done) return done.error();
  const auto shown = Show(session, files, shared);
  return done ? shown : done;
}

/// The session that RunSway recorded, with its trials measured again.
Result<sway::Session> ReadSway(const SwayOptions& options) {
  const auto recorded = recording::RecordedSession::Open(options.from);
  if (!recorded) return recorded.error();
  std::optional<sway::Session> session;
  for (const mcap::Metadata& one : recorded->metadata()) {
    if (one.name == kPlanRecord) {
      auto plan = sway::PlanFromJson(mcap::TextOf(one.values, "plan"));
      if (!plan) return InvalidData(options.from + ": " + plan.error().message);
      session = std::move(*plan);
    } else if (one.name == kTrialRecord && session) {
      auto trial = sway::TrialFromJson(mcap::TextOf(one.values, "trial"));
      if (!trial) return InvalidData(options.from + ": " + trial.error().message);
      session->trials.push_back(std::move(*trial));
    }
  }
  if (!session) {
    return InvalidData(options.from +
                       " is not a recording of footing-ctl sway; to measure any other one as a "
                       "whole, export it as CSV, then: footing-eval board --corners");
  }
  session->recording = options.from;
  if (!options.filter.rate.empty() || !options.filter.cutoff.empty() ||
      options.filter.window_s > 0) {
    const auto filter = posturography::CopFilterOf(options.filter, true);
    if (!filter) return filter.error();
    session->filter = *filter;
  }
  if (session->boards.size() > 1 && session->filter.rate_hz <= 0) {
    return UsageError("--rate-hz recorded: two boards sample at times of their own; give a rate");
  }
  Samples samples(session->boards);
  for (const recording::RecordedServer& server : recorded->servers()) {
    if (server.server_id != "footingd") continue;
    const auto ticks =
        recording::ReadTicks(server, {v1::Tick::kStatusFieldNumber, v1::Tick::kBoardsFieldNumber});
    if (!ticks) return InvalidData(options.from + ": " + ticks.error().message);
    // A device's number stands for one serial, which a later tick may say.
    std::vector<stream::DeviceStatus> devices;
    std::vector<stream::BoardSample> boards;
    for (const v1::Tick& tick : *ticks) {
      const rig::Tick sensors = wire::SensorTick(tick);
      for (const auto& device : sensors.devices.value_or(std::vector<stream::DeviceStatus>())) {
        const bool known = std::any_of(devices.begin(), devices.end(), [&](const auto& one) {
          return one.device == device.device;
        });
        if (!known) devices.push_back(device);
      }
      boards.insert(boards.end(), sensors.boards.begin(), sensors.boards.end());
    }
    samples.Take(boards, devices);
  }
  for (sway::Trial& trial : session->trials) {
    if (!trial.rejected.empty()) continue;
    sway::MeasureTrial(session->boards, samples.tracks(), session->filter, trial);
  }
  return std::move(*session);
}

Result<void> ReplaySway(const SwayOptions& options, const Shared& shared) {
  std::optional<OutputFiles> files;
  if (!options.out.empty()) {
    files.emplace(WithoutEnding(options.out));
    if (const auto good = files->CheckCreatable(options.replace); !good) return good.error();
  }
  const auto session = ReadSway(options);
  if (!session) return session.error();
  if (files) {
    if (const auto done = files->Write(*session); !done) return done.error();
  }
  return Show(*session, files, shared);
}

Result<void> CheckPlan(const SwayOptions& options) {
  const std::size_t conditions =
      options.eyes.size() * options.surfaces.size() * options.feet.size();
  if (conditions > sway::kMostConditions) {
    return UsageError(std::to_string(conditions) +
                      " conditions: a session, and its page, has at "
                      "most " +
                      std::to_string(sway::kMostConditions) + "; make several");
  }
  return {};
}

void AddProtocol(CLI::App& command, SwayOptions& options) {
  command.add_option("--subject", options.subject, "Code of the subject, for the report")
      ->capture_default_str();
  command.add_option("--notes", options.notes, "Notes for the report");
  const auto list = [&](const char* name, std::vector<std::string>& values,
                        const std::vector<std::string>& known, const std::string& help) {
    command.add_option(name, values, help + ": " + text::Joined(known) + "; separated by commas")
        ->delimiter(',')
        ->check(CLI::IsMember(known))
        ->capture_default_str();
  };
  list("--eyes", options.eyes, sway::kEyes, "Eyes");
  list("--surface", options.surfaces, sway::kSurfaces, "Surface");
  list("--feet", options.feet, sway::kFeet, "Feet");
  command.add_option("--repeats", options.repeats, "Trials of each condition")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command.add_option("--seconds", options.seconds, "Duration of a trial, s")
      ->check(CLI::Range(1.0, 600.0))
      ->capture_default_str();
  command.add_option("--settle-s", options.settle_s, "Standing before each trial, counted down, s")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command.add_option("--attempts", options.attempts, "Attempts at a trial that does not count")
      ->check(CLI::Range(1, 20))
      ->capture_default_str();
  command.add_option("--wait-s", options.wait_s, "Longest wait for the subject or a lost board, s")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
}

}  // namespace

void AddSwayCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<SwayOptions>();
  CLI::App* command = app.add_subcommand(
      "sway", "Quiet standing on one or two boards: guided trials, measures, a report");
  AddProtocol(*command, *options);
  command->add_option("--rate-hz", options->filter.rate,
                      "Even rate of the COP by window averages, Hz, or recorded (default 50)");
  command->add_option("--cutoff-hz", options->filter.cutoff,
                      "Low-pass without lag, Butterworth of 4th order: its cutoff, Hz, or none "
                      "(default 10)");
  command
      ->add_option("--window-s", options->filter.window_s,
                   "Window of the averages, s (default: 2 intervals of the slower rate)")
      ->check(CLI::Range(0.001, 10.0));
  command->add_option("--rig", options->rig, "Rig: the devices of one person")
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "Files to write: OUT.mcap, OUT.csv, OUT_cop.csv and OUT.html (default sway; "
                      "none with --from)");
  command->add_flag("--force", options->replace, "Overwrite existing files");
  command->add_flag("--script", options->script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->add_option("--from", options->from,
                      "Recording of an earlier session: measure it again; needs no device");
  command->footer(
      "Examples:\n"
      "  footing-ctl sway --subject P01 --out P01        # eyes open and closed, 3 x 30 s each\n"
      "  footing-ctl sway --surface firm,foam --feet together --seconds 60 --out P02\n"
      "  footing-ctl sway --from P01.mcap --cutoff-hz 5 --json\n"
      "On a terminal Enter starts each trial, else the step onto the boards.");
  command->callback([options, &shared] {
    Result<void> done = CheckPlan(*options);
    const auto filter = posturography::CopFilterOf(options->filter, true);
    if (done && !filter) done = filter.error();
    if (done && options->from.empty()) {
      // Everything, so that the recording can be run again.
      WithSession(shared, {}, [&](Connection& connection) {
        return RunSway(connection, *options, *filter, shared);
      });
      return;
    }
    if (done) done = ReplaySway(*options, shared);
    if (!done) shared.exit_code = cli::Report(done.error());
  });
}

}  // namespace footing::ctl
