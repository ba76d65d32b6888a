#include "clients/ctl/acceptance_run.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "clients/ctl/commands.h"
#include "clients/ctl/guided.h"
#include "common/base/units.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/recording/mcap_records.h"
#include "common/recording/recorded_session.h"
#include "common/recording/stream_recorder.h"
#include "common/rig/follower.h"
#include "common/runtime/clock.h"
#include "common/stream/roles.h"
#include "common/wire/wire.h"

namespace footing::ctl {
namespace {

constexpr double kAcceptanceStepS = 0.05;
constexpr double kRumbleEveryS = 1;
constexpr std::uint32_t kRumbleLeaseMs = 600;
constexpr double kLedEveryS = 0.8;  // Status comes once a second at the slowest.

/// The rumble and the lamps during their phases: a command now and then for every controller.
class Actuators {
 public:
  void Drive(Connection& session, const std::string& rig, guide::Phase phase, std::int64_t now_ns) {
    const bool rumble = phase == guide::Phase::kRumble;
    if (!rumble && phase != guide::Phase::kLed) return;
    const double every_s = rumble ? kRumbleEveryS : kLedEveryS;
    if (now_ns - last_ns_ < SecondsToNanoseconds(every_s)) return;
    last_ns_ = now_ns;
    ++count_;
    for (const auto& device : DevicesOf(session, rig)) {
      const bool board = device.kind == stream::DeviceKind::kBalanceBoard;
      if (board && rumble) continue;
      v1::Command command;
      if (rumble) {
        command.mutable_set_rumble()->set_device(device.device);
        command.mutable_set_rumble()->set_on(true);
        command.mutable_set_rumble()->set_lease_ms(kRumbleLeaseMs);
      } else {
        command.mutable_set_leds()->set_device(device.device);
        command.mutable_set_leds()->set_leds(board ? count_ % 2 : count_ % 16);
      }
      // The device's status shows the outcome, and the checks read it there.
      (void)session.Call(std::move(command)).ok();
    }
  }

  /// The lamps show the roles again.
  void Restore(Connection& session, const std::string& rig) {
    for (const auto& device : DevicesOf(session, rig)) {
      v1::Command command;
      command.mutable_set_leds()->set_device(device.device);
      command.mutable_set_leds()->set_leds(stream::LedsOf(device.role));
      (void)session.Call(std::move(command)).ok();
    }
  }

 private:
  std::int64_t last_ns_ = 0;
  std::uint32_t count_ = 0;
};

/// Everything of one run: the recording, the measurement, and where in the plan it is.
class Run {
 public:
  Run(Connection& session, const AcceptanceOptions& options, stream::BoardLayout layout,
      recording::RecordingWriter writer)
      : session_(session),
        options_(options),
        layout_(std::move(layout)),
        writer_(std::move(writer)),
        recorder_(writer_, "footingd", [](const std::string& id) { return id; }),
        acceptance_(options.rig, layout_) {}

  Result<AcceptanceVerdict> Go(const std::vector<guide::Planned>& plan) {
    Keep(recorder_.OnWelcome(session_.welcome(), clock::MonotonicNs()));
    session_.set_on_tick(
        [this](const v1::Tick& tick, const rig::Tick& sensors) { Take(tick, sensors); });
    Actuators actuators;
    for (const guide::Planned& planned : plan) {
      if (!kept_) break;
      std::cerr << (options_.script ? "PROMPT: " : "\n> ") << guide::Prompt(planned.phase)
                << std::endl;
      next_ = planned.phase;
      double left_s = planned.duration_s;
      for (std::int64_t before_ns = clock::MonotonicNs(); left_s > 0 && kept_;) {
        if (session_.RunFor(std::min(kAcceptanceStepS, left_s)) == Waited::kInterrupted) {
          kept_ = Failure("stopped before the verdict; " + writer_.path() + " has no end");
        }
        actuators.Drive(session_, options_.rig, planned.phase, session_.server_ns());
        const std::int64_t now_ns = clock::MonotonicNs();
        left_s -= NanosecondsToSeconds(now_ns - before_ns);
        before_ns = now_ns;
        Keep(writer_.Flush());
      }
    }
    ending_ = true;
    session_.RunFor(2 * kAcceptanceStepS);  // One more tick, at which the last phase ends.
    session_.set_on_tick({});
    actuators.Restore(session_, options_.rig);
    return Finish();
  }

 private:
  /// Phases change at ticks, so that a replay changes them at the same place.
  void Take(const v1::Tick& tick, const rig::Tick& sensors) {
    Keep(recorder_.OnTick(tick, clock::MonotonicNs()));
    if (ending_) {
      acceptance_.End(tick.host_ns());
    } else if (next_) {
      acceptance_.Begin(*std::exchange(next_, std::nullopt), tick.host_ns());
    }
    acceptance_.Take(sensors);
  }

  void Keep(Result<void> written) {
    if (!written && kept_) kept_ = std::move(written);
  }

  Result<AcceptanceVerdict> Finish() {
    AcceptanceVerdict verdict{acceptance_.Checks(), writer_.path()};
    Keep(writer_.AddMetadata(
        "acceptance",
        AcceptanceMetadata(options_.rig, layout_, acceptance_.spans(), verdict.checks)));
    Keep(recorder_.OnEnd({}, clock::MonotonicNs()));
    Keep(writer_.Finish());
    if (!kept_) return kept_.error();
    return verdict;
  }

  Connection& session_;
  const AcceptanceOptions& options_;
  stream::BoardLayout layout_;
  recording::RecordingWriter writer_;
  recording::StreamRecorder recorder_;
  guide::Acceptance acceptance_;
  std::optional<guide::Phase> next_;
  bool ending_ = false;
  Result<void> kept_;
};

}  // namespace

Result<AcceptanceVerdict> RunAcceptance(Connection& session, const AcceptanceOptions& options) {
  std::size_t boards = 0;
  std::size_t body_devices = 0;
  for (const auto& device : DevicesOf(session, options.rig)) {
    ++(device.kind == stream::DeviceKind::kBalanceBoard ? boards : body_devices);
  }
  if (boards + body_devices == 0) {
    return NoDevice("rig " + options.rig + " has no device; see footing-ctl devices");
  }
  stream::BoardLayout layout =
      *board::LayoutNamed(boards > 1 ? "one_foot_each" : "single", board::kUsualGapMm);
  for (const auto& rig : session.setup()) {
    if (rig.rig == options.rig && !rig.layout.preset.empty()) layout = rig.layout;
  }
  auto writer = CreateRecording(options.out, options.replace);
  if (!writer) return writer.error();
  return Run(session, options, layout, std::move(*writer))
      .Go(guide::PlanOf(options.minutes, body_devices > 0, boards > 0));
}

namespace {

using nlohmann::ordered_json;

std::string Rounded(double value) { return ordered_json(std::round(value * 1000) / 1000).dump(); }

/// Prints the verdict; a failure when it is one.
Result<void> Show(const AcceptanceVerdict& verdict, const Shared& shared) {
  const bool passed = guide::Passed(verdict.checks);
  ordered_json out{{"verdict", passed ? "pass" : "fail"}, {"checks", ordered_json::array()}};
  std::string text;
  std::string failed;
  for (const guide::Check& check : verdict.checks) {
    out["checks"].push_back({{"name", check.name},
                             {"passed", check.passed},
                             {"value", check.value},
                             {"bar", check.bar},
                             {"unit", check.unit},
                             {"note", check.note}});
    text += std::string(check.passed ? "  ok    " : "  FAIL  ") + check.name + ": " +
            Rounded(check.value) + " (bar " + Rounded(check.bar) + ") " + check.unit + "  " +
            check.note + "\n";
    if (!check.passed && failed.empty()) {
      failed = check.name + ": " + Rounded(check.value) + " (bar " + Rounded(check.bar) + ") " +
               check.unit + " " + check.note;
    }
  }
  out["recording"] = verdict.recording;
  Print(out, text + "verdict: " + (passed ? "pass" : "fail") + ", " + verdict.recording, shared);
  if (!passed) return Failure("not accepted; " + failed);
  return {};
}

struct AcceptanceArguments {
  AcceptanceOptions options;
  std::string replay;
};

}  // namespace

void AddAcceptanceCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<AcceptanceArguments>();
  CLI::App* command = app.add_subcommand(
      "acceptance", "Guided acceptance test of a rig: writes a recording and prints the verdict");
  command->add_option("--minutes", arguments->options.minutes, "Duration, min (default 10)")
      ->check(CLI::Range(0.1, 120.0));
  command->add_option("--out", arguments->options.out,
                      "Recording to write (default acceptance.mcap)");
  command->add_flag("--force", arguments->options.replace, "Overwrite an existing recording");
  command->add_option("--rig", arguments->options.rig,
                      "Rig: the devices of one person (default main)");
  command->add_flag("--script", arguments->options.script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->add_option("--replay", arguments->replay,
                      "Recording of an acceptance: compute its verdict again; needs no device");
  command->footer(
      "Examples:\n  footing-ctl acceptance --out first.mcap\n"
      "  footing-ctl acceptance --replay first.mcap --json");
  command->callback([arguments, &shared] {
    if (!arguments->replay.empty()) {
      const auto verdict = ReplayAcceptance(arguments->replay);
      const Result<void> shown = verdict ? Show(*verdict, shared) : Result<void>(verdict.error());
      if (!shown) shared.exit_code = cli::Report(shown.error());
      return;
    }
    if (arguments->options.out.empty()) arguments->options.out = "acceptance.mcap";
    // Everything, so that the recording can be run again.
    WithSession(shared, {}, [&](Connection& session) -> Result<void> {
      const auto verdict = RunAcceptance(session, arguments->options);
      if (!verdict) return verdict.error();
      return Show(*verdict, shared);
    });
  });
}

namespace {

using v1::Tick;

const std::vector<std::uint32_t>& JudgedFields() {
  static const std::vector<std::uint32_t> fields = {
      Tick::kStatusFieldNumber, Tick::kMotionFieldNumber, Tick::kBoardsFieldNumber,
      Tick::kFeaturesFieldNumber};
  return fields;
}

/// Plan that RunAcceptance stored as metadata of the recording; nothing when there is none.
std::optional<std::map<std::string, std::string>> KeptPlan(
    const recording::RecordedSession& session) {
  for (const mcap::Metadata& one : session.metadata()) {
    if (one.name == "acceptance") return std::map(one.values.begin(), one.values.end());
  }
  return std::nullopt;
}

}  // namespace

Result<AcceptanceVerdict> ReplayAcceptance(const std::string& path) {
  const auto session = recording::RecordedSession::Open(path);
  if (!session) {
    return Error{session.error().kind,
                 session.error().message + "; a run that did not end has no verdict to compute"};
  }
  const auto metadata = KeptPlan(*session);
  if (!metadata) {
    return InvalidData(path +
                       " is not an acceptance recording; record one with: footing-ctl "
                       "acceptance --out FILE.mcap");
  }
  const auto plan = ReadAcceptanceMetadata(*metadata);
  if (!plan) return InvalidData(path + ": " + plan.error().message);
  guide::Acceptance acceptance(plan->rig, plan->layout);
  auto span = plan->spans.begin();
  const recording::RecordedServer* server = session->Find("footingd");
  if (server == nullptr) return InvalidData(path + " has no ticks of footingd");
  const auto ticks = recording::ReadTicks(*server, JudgedFields());
  if (!ticks) return InvalidData(path + ": " + ticks.error().message);
  for (const v1::Tick& tick : *ticks) {
    if (span != plan->spans.end() && tick.host_ns() >= span->from_ns) {
      acceptance.Begin(span->phase, span->from_ns);
      ++span;
    }
    if (span == plan->spans.end() && !plan->spans.empty() &&
        tick.host_ns() >= plan->spans.back().to_ns) {
      acceptance.End(plan->spans.back().to_ns);
    }
    acceptance.Take(wire::SensorTick(tick));
  }
  return AcceptanceVerdict{acceptance.Checks(), path};
}

namespace {

stream::BoardPose PoseOf(const ordered_json& json) {
  return {json.at("x_m").get<double>(), json.at("y_m").get<double>(),
          json.at("yaw_rad").get<double>()};
}

}  // namespace

ordered_json BoardPoseJson(const stream::BoardPose& pose) {
  return {{"x_m", pose.x_m}, {"y_m", pose.y_m}, {"yaw_rad", pose.yaw_rad}};
}

std::map<std::string, std::string> AcceptanceMetadata(const std::string& rig,
                                                      const stream::BoardLayout& layout,
                                                      const std::vector<guide::Span>& spans,
                                                      const std::vector<guide::Check>& checks) {
  ordered_json phases = ordered_json::array();
  for (const guide::Span& span : spans) {
    phases.push_back(
        {{"phase", guide::Name(span.phase)}, {"from_ns", span.from_ns}, {"to_ns", span.to_ns}});
  }
  ordered_json list = ordered_json::array();
  for (const guide::Check& check : checks) {
    list.push_back({{"name", check.name},
                    {"passed", check.passed},
                    {"value", check.value},
                    {"bar", check.bar},
                    {"unit", check.unit},
                    {"note", check.note}});
  }
  const ordered_json lies{{"preset", layout.preset},
                          {"gap_mm", layout.gap_mm},
                          {"left", BoardPoseJson(layout.left)},
                          {"right", BoardPoseJson(layout.right)}};
  return {{"rig", rig},
          {"layout", lies.dump()},
          {"phases", phases.dump()},
          {"checks", list.dump()},
          {"verdict", guide::Passed(checks) ? "pass" : "fail"}};
}

Result<AcceptancePlan> ReadAcceptanceMetadata(const std::map<std::string, std::string>& metadata) {
  AcceptancePlan plan;
  try {
    plan.rig = metadata.at("rig");
    const auto lies = ordered_json::parse(metadata.at("layout"));
    plan.layout.preset = lies.at("preset").get<std::string>();
    plan.layout.gap_mm = lies.at("gap_mm").get<double>();
    plan.layout.left = PoseOf(lies.at("left"));
    plan.layout.right = PoseOf(lies.at("right"));
    for (const auto& json : ordered_json::parse(metadata.at("phases"))) {
      const auto phase = guide::PhaseNamed(json.at("phase").get<std::string>());
      if (!phase) return InvalidData("its phase " + json.at("phase").dump() + " is not known");
      plan.spans.push_back(
          {*phase, json.at("from_ns").get<std::int64_t>(), json.at("to_ns").get<std::int64_t>()});
    }
  } catch (const std::out_of_range& error) {
    return InvalidData(std::string("its metadata lacks a part: ") + error.what());
  } catch (const ordered_json::exception& error) {
    return InvalidData(std::string("its metadata is invalid: ") + error.what());
  }
  return plan;
}

namespace {

struct LayoutArguments {
  std::string rig = "main";
  std::string preset;
  double gap_mm = board::kUsualGapMm;
  bool check = false;
  bool script = false;
};

std::string Millimetres(double metres) { return std::to_string(std::lround(metres * 1e3)) + " mm"; }

std::string PoseText(const stream::BoardPose& pose) {
  return Millimetres(pose.x_m) + " forward, " + Millimetres(pose.y_m) + " left, turned by " +
         std::to_string(std::lround(RadiansToDegrees(pose.yaw_rad))) + " degrees";
}

Result<void> Layout(Connection& session, const LayoutArguments& arguments, const Shared& shared) {
  stream::BoardLayout layout;
  for (const auto& rig : session.setup()) {
    if (rig.rig == arguments.rig) layout = rig.layout;
  }
  v1::CommandResult set;
  if (!arguments.preset.empty()) {
    layout = *board::LayoutNamed(arguments.preset, arguments.gap_mm);
    layout.rig = arguments.rig;
    v1::Command command;
    *command.mutable_set_board_layout()->mutable_layout() = wire::ToProto(layout);
    const auto done = session.Call(std::move(command));
    if (!done) return done.error();
    set = *done;
  }
  if (layout.preset.empty() && !arguments.check) {
    return Failure("rig " + arguments.rig +
                   " has no layout; set one: footing-ctl layout --preset one_foot_each");
  }
  ordered_json out{{"rig", arguments.rig},
                   {"preset", layout.preset},
                   {"gap_mm", layout.gap_mm},
                   {"left", BoardPoseJson(layout.left)},
                   {"right", BoardPoseJson(layout.right)}};
  std::string text =
      "rig " + arguments.rig + ": " + layout.preset + "\n  left board:  " + PoseText(layout.left);
  if (layout.preset != "single") text += "\n  right board: " + PoseText(layout.right);
  AddRemark(set, out, text);
  Result<void> verdict;
  if (arguments.check) {
    guide::SetUpOptions options;
    options.rig = arguments.rig;
    options.preset = arguments.preset;
    options.gap_mm = arguments.gap_mm;
    const auto results =
        RunGuided(session, options, {guide::Item::kLayout}, PromptOptions{arguments.script});
    if (!results) return results.error();
    if (results->empty()) {
      return NoDevice("rig " + arguments.rig + " has no board" +
                      (arguments.preset.empty() ? "" : ": its layout is set, but not checked"));
    }
    out["check"] = ToJson(results->back());
    text += "\n" + ToText(results->back());
    if (!results->back().passed) verdict = Failure(results->back().note);
  }
  Print(out, text, shared);
  return verdict;
}

}  // namespace

void AddLayoutCommand(CLI::App& app, Shared& shared) {
  const auto arguments = std::make_shared<LayoutArguments>();
  CLI::App* command = app.add_subcommand("layout", "Show, set or check the layout of the boards");
  command->add_option("--preset", arguments->preset,
                      "Layout: one_foot_each, side_by_side or single");
  command
      ->add_option("--gap-mm", arguments->gap_mm,
                   "Gap between the facing edges of the boards, mm (default 20)")
      ->check(CLI::Range(0.0, 2000.0));
  command->add_option("--rig", arguments->rig, "Rig: the devices of one person (default main)");
  command->add_flag("--check", arguments->check,
                    "Check the layout: stand left, stand right, lean forward");
  command->add_flag("--script", arguments->script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->footer(
      "Examples:\n  footing-ctl layout\n"
      "  footing-ctl layout --preset one_foot_each --gap-mm 20 --check");
  command->callback([arguments, &shared] {
    if (!arguments->preset.empty() && !board::LayoutNamed(arguments->preset, 0)) {
      shared.exit_code = cli::Report(
          UsageError("--preset " + arguments->preset +
                     ": no such layout; must be one of: one_foot_each side_by_side single"));
      return;
    }
    WithSession(shared, GuidedChannels(),
                [&](Connection& session) { return Layout(session, *arguments, shared); });
  });
}

}  // namespace footing::ctl
