#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "clients/ctl/commands.h"
#include "clients/ctl/guided.h"
#include "common/cli/cli.h"
#include "common/guide/own_motion.h"
#include "common/recording/recording_writer.h"
#include "common/recording/stream_recorder.h"
#include "common/runtime/clock.h"

namespace footing::ctl {
namespace {

using nlohmann::ordered_json;

constexpr double kMotionsStepS = 0.1;
constexpr double kLeastTPoseS = 6;  // The engine's takes five.
constexpr double kMostTPoseS = 90;

struct MotionsOptions {
  std::string out = "own_motion.mcap";
  bool replace = false, script = false;
};

/// The two guided minutes, recorded from their first tick on.
class GuidedMotions {
 public:
  GuidedMotions(Connection& session, const MotionsOptions& options,
                recording::RecordingWriter writer)
      : session_(session),
        options_(options),
        writer_(std::move(writer)),
        recorder_(writer_, "footing-sim", [](const std::string& id) { return id; }) {}

  Result<void> Go() {
    Keep(recorder_.OnWelcome(session_.welcome(), clock::MonotonicNs()));
    session_.set_on_tick([this](const v1::Tick& tick, const rig::Tick&) { Take(tick); });
    v1::Command command;
    command.mutable_calibrate_t_pose();
    if (const auto asked = session_.Call(std::move(command)); !asked) return asked.error();
    for (const guide::MotionStep& step : guide::OwnMotionSteps()) {
      if (!kept_) break;
      std::cerr << (options_.script ? "PROMPT: " : "\n> ") << step.prompt << std::endl;
      const bool first = &step == &guide::OwnMotionSteps().front();
      Wait(first ? kLeastTPoseS : step.seconds);
      if (first) AwaitTPose(step.seconds - kLeastTPoseS);
      counting_ = true;
    }
    session_.set_on_tick({});
    Keep(recorder_.OnEnd({}, clock::MonotonicNs()));
    Keep(writer_.Finish());
    return kept_;
  }

  double valid_share() const { return frames_ > 0 ? valid_ / frames_ : 0; }
  const std::string& subject() const { return subject_; }

 private:
  void Wait(double left_s) {
    for (; left_s > 0 && kept_; left_s -= kMotionsStepS) {
      if (session_.RunFor(std::min(kMotionsStepS, left_s)) == Waited::kInterrupted) {
        Keep(Failure("stopped; " + options_.out + " has only a part of the motion"));
      }
      Keep(writer_.Flush());
    }
  }

  void AwaitTPose(double rest_s) {
    for (double waited_s = 0; !calibrated_ && kept_; waited_s += kMotionsStepS) {
      Wait(kMotionsStepS);
      if (waited_s > kMostTPoseS) {
        Keep(Failure("the T-pose was not taken" + (note_.empty() ? "" : ": " + note_) +
                     "; run footing-ctl motions --force again"));
      }
    }
    Wait(rest_s);
  }

  void Take(const v1::Tick& tick) {
    Keep(recorder_.OnTick(tick, clock::MonotonicNs()));
    if (!tick.has_characters() || tick.characters().characters_size() == 0) return;
    const v1::Character& character = tick.characters().characters(0);
    calibrated_ = character.body().calibrated();
    note_ = character.body().note();
    subject_ = character.body().subject();
    if (!counting_) return;
    ++frames_;
    valid_ += character.valid() ? 1 : 0;
  }

  void Keep(Result<void> written) {
    if (!written && kept_) kept_ = std::move(written);
  }

  Connection& session_;
  const MotionsOptions& options_;
  recording::RecordingWriter writer_;
  recording::StreamRecorder recorder_;
  bool calibrated_ = false, counting_ = false;
  std::string note_, subject_;
  double frames_ = 0, valid_ = 0;
  Result<void> kept_;
};

Result<void> RunMotions(const MotionsOptions& options, const Shared& shared) {
  const auto session = OpenSimulation(shared, {}, "footing-sim --engine pose --subject FILE");
  if (!session) return session.error();
  auto writer = CreateRecording(options.out, options.replace);
  if (!writer) return writer.error();
  GuidedMotions motions(**session, options, std::move(writer).value());
  if (const auto done = motions.Go(); !done) return done;
  const std::string code = motions.subject();
  const std::string name = code.empty() ? "CODE" : code;
  Print(
      ordered_json{
          {"recording", options.out}, {"subject", code}, {"valid_share", motions.valid_share()}},
      options.out + ": " + std::to_string(std::lround(100 * motions.valid_share())) +
          " % of the frames are valid; now run: footing-train person --recording " + options.out +
          " --subject " + name + " --out " + name + ".fmodel",
      shared);
  return {};
}

}  // namespace

void AddMotionsCommand(CLI::App& app, Shared& shared) {
  const auto options = std::make_shared<MotionsOptions>();
  CLI::App* command = app.add_subcommand(
      "motions", "Two guided minutes of the subject's own motion, recorded from footing-sim");
  command->add_option("--out", options->out, "Recording to write (default own_motion.mcap)");
  command->add_flag("--force", options->replace, "Overwrite an existing recording");
  command->add_flag("--script", options->script,
                    "Print prompts as lines PROMPT: ... on standard error");
  command->footer(
      "Examples:\n"
      "  footing-ctl motions --out p07.mcap   # connects to footing-sim\n"
      "  footing-train person --recording p07.mcap --subject p07 --out p07.fmodel");
  command->callback([options, &shared] {
    if (const auto done = RunMotions(*options, shared); !done) {
      shared.exit_code = cli::Report(done.error());
    }
  });
}

}  // namespace footing::ctl
