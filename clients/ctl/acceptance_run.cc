#include "clients/ctl/acceptance_run.h"

#include <algorithm>
#include <iostream>
#include <optional>
#include <utility>

#include "clients/ctl/acceptance_text.h"
#include "clients/ctl/guided.h"
#include "common/board/layout.h"
#include "common/cli/cli.h"
#include "common/runtime/clock.h"
#include "common/recording/stream_recorder.h"
#include "common/base/units.h"
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
  void Drive(Session& session, const std::string& rig, guide::Phase phase, std::int64_t now_ns) {
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
      // What came of it is in the device's status, and so in the checks.
      (void)session.Call(std::move(command)).ok();
    }
  }

  /// The lamps show the roles again.
  void Restore(Session& session, const std::string& rig) {
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
  Run(Session& session, const AcceptanceOptions& options, stream::BoardLayout layout,
      recording::RecordingWriter writer)
      : session_(session),
        options_(options),
        layout_(std::move(layout)),
        writer_(std::move(writer)),
        recorder_(writer_, "footingd", [](const std::string& id) { return id; }),
        acceptance_(options.rig, layout_) {}

  Result<AcceptanceVerdict> Go(const std::vector<guide::Planned>& plan) {
    Keep(recorder_.OnWelcome(session_.welcome(), clock::MonotonicNs()));
    session_.set_on_tick([this](const v1::Tick& tick) { Take(tick); });
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
  void Take(const v1::Tick& tick) {
    Keep(recorder_.OnTick(tick, clock::MonotonicNs()));
    if (ending_) {
      acceptance_.End(tick.host_ns());
    } else if (next_) {
      acceptance_.Begin(*std::exchange(next_, std::nullopt), tick.host_ns());
    }
    TakeTick(tick, acceptance_);
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

  Session& session_;
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

Result<AcceptanceVerdict> RunAcceptance(Session& session, const AcceptanceOptions& options) {
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
  recording::WriterSettings settings;
  settings.library = std::string("footing-ctl ") + cli::Version();
  settings.replace = options.replace;
  auto writer = recording::RecordingWriter::Create(options.out, settings);
  if (!writer) return writer.error();
  return Run(session, options, layout, std::move(*writer))
      .Go(guide::PlanOf(options.minutes, body_devices > 0, boards > 0));
}

}  // namespace footing::ctl
