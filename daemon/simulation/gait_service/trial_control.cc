#include "daemon/simulation/gait_service/trial_control.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "common/runtime/files.h"
#include "common/wire/wire.h"
#include "daemon/simulation/biped/track.h"
#include "daemon/simulation/biped/trial.h"
#include "daemon/simulation/gait_service/publish.h"
#include "daemon/simulation/serving/messages.h"

namespace footing::gait_service {
namespace {

constexpr std::size_t kMaxId = 64;

bool IsId(const std::string& id) {
  const auto allowed = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_' || c == '.';
  };
  return !id.empty() && id.size() <= kMaxId && std::all_of(id.begin(), id.end(), allowed);
}

/// The task of that name; with an empty one the seed draws it.
Result<int> TaskOf(const v1::StartTrial& message, const stream::Track& track) {
  if (message.task().empty()) return trial::DrawTask(track, message.seed());
  std::string names;
  for (std::size_t i = 0; i < track.tasks.size(); ++i) {
    if (track.tasks[i].name == message.task()) return static_cast<int>(i);
    names += (names.empty() ? "" : ", ") + track.tasks[i].name;
  }
  return UsageError("start_trial: the track has no task \"" + message.task() + "\"; " +
                    (names.empty() ? "it has no tasks" : "there are: " + names));
}

v1::CommandResult ToResult(const Result<void>& done) {
  return serving::Answer(done.ok(), done ? "" : done.error().message);
}

}  // namespace

TrialControl::TrialControl(Options options, stream::Track first, TrackExchange& tracks)
    : options_(std::move(options)), exchange_(tracks) {
  trials_.push_back({0, "", 0, options_.track, std::move(first)});
}

bool TrialControl::Takes(const v1::Command& command) {
  return command.has_start_trial() || command.has_stop_trial() || command.has_correct_failure();
}

v1::CommandResult TrialControl::OnCommand(const v1::Command& command) {
  if (command.has_start_trial()) return ToResult(Start(command.start_trial()));
  if (command.has_stop_trial()) return ToResult(Stop(command.stop_trial()));
  return ToResult(failures_.Correct(command.correct_failure()));
}

/// A client may name built-in tracks; of files only the one that the server was started with.
Result<stream::Track> TrialControl::Read(const std::string& name) const {
  const bool path = name.find('/') != std::string::npos || name.find('.') != std::string::npos;
  if (path && name != options_.track) {
    return UsageError("start_trial: \"" + name +
                      "\" is not the name of a built-in track; a file can only be the one that "
                      "footing-sim was started with (--track FILE)");
  }
  const auto text =
      path ? config::ReadTextFile(name) : config::ReadNamed(name, "tracks", options_.data_folder);
  if (!text) return Error{text.error().kind, "start_trial: " + text.error().message};
  return terrain::ParseTrack(*text, name);
}

Result<void> TrialControl::Start(const v1::StartTrial& message) {
  if (!IsId(message.trial())) {
    return UsageError("start_trial: trial must be 1 to 64 letters, digits, - _ and .");
  }
  if (trials_.size() > TrackExchange::kMost) {
    return Failure("start_trial: the trial before is not in place yet; try again in a moment");
  }
  const std::string name = message.track().empty() ? trials_.back().track_name : message.track();
  auto track = Read(name);
  if (!track) return track.error();
  track->number = trials_.back().track.number + 1;
  const auto task = TaskOf(message, *track);
  if (!task) return task.error();
  auto world = engine::MakeTrackWorld(*track, options_.biped, options_.step_s);
  if (!world) return world.error();
  if (!exchange_.next.Push(std::move(world).value())) {
    return Failure("start_trial: the trial before is not in place yet; try again in a moment");
  }
  ++inputs_.number;
  inputs_.task = *task;
  inputs_.track_number = track->number;
  trials_.push_back(
      {inputs_.number, message.trial(), message.seed(), name, std::move(track).value()});
  return {};
}

Result<void> TrialControl::Stop(const v1::StopTrial& message) {
  const Trial& newest = trials_.back();
  if (!message.trial().empty() && message.trial() != newest.id) {
    return UsageError("stop_trial: \"" + message.trial() + "\" is not the newest trial" +
                      (newest.id.empty() ? "" : "; that is \"" + newest.id + "\""));
  }
  if (!GoesOn()) {
    return Failure("stop_trial: no trial is ready or running" +
                   (newest.id.empty() ? "" : ": \"" + newest.id + "\" is over"));
  }
  StopNewest();
  return {};
}

bool TrialControl::GoesOn() const {
  const Trial& newest = trials_.back();
  const bool running = trials_.size() > 1 || phase_ == stream::TrialPhase::kRunning;
  const bool ready = phase_ == stream::TrialPhase::kReady && !newest.id.empty();
  return newest.number >= inputs_.stopped_below && (running || ready);
}

Result<void> TrialControl::CheckNoneGoesOn() const {
  if (!GoesOn()) return {};
  const Trial& newest = trials_.back();
  return Failure("a trial" + (newest.id.empty() ? "" : " (" + newest.id + ")") +
                 " is ready or running; stop it first (footing-ctl trial stop)");
}

bool TrialControl::OnFrame(const Frame& frame) {
  phase_ = frame.output.trial.phase;
  std::unique_ptr<engine::TrackWorld> done;
  while (exchange_.done.Pop(done)) done.reset();
  bool switched = false;
  for (; trials_.size() > 1 && trials_.front().number < frame.output.trial_number;
       switched = true) {
    trials_.pop_front();
  }
  return switched;
}

const TrialControl::Trial& TrialControl::TrialNumbered(std::uint64_t number) const {
  for (const Trial& trial : trials_) {
    if (trial.number == number) return trial;
  }
  return trials_.front();
}

v1::TrialState TrialControl::StateOf(const Trial& trial,
                                     const stream::TrialProgress& progress) const {
  const stream::Track& track = trial.track;
  const stream::FailureCounts withdrawn = failures_.WithdrawnOf(trial.number);
  stream::TrialState state;
  state.progress = progress;
  state.progress.failures = stream::Without(progress.failures, withdrawn);
  state.withdrawn_failures = stream::Total(withdrawn);
  state.trial = trial.id;
  state.number = trial.number;
  state.track = trial.track_name;
  state.seed = trial.seed;
  state.finish_m = track.finish_m;
  const auto task = static_cast<std::size_t>(progress.task);
  if (progress.task >= 0 && task < track.tasks.size()) {
    state.task = track.tasks[task].name;
    state.instruction = track.tasks[task].instruction;
    state.to_mark_m = track.mark_m - progress.distance_m;
  }
  return wire::ToProto(state);
}

v1::Event TrialControl::ToEvent(const engine::EngineEvent& event, std::int64_t host_ns) {
  v1::Event message = gait_service::ToEvent(event, host_ns);
  const Trial& trial = TrialNumbered(event.trial_number);
  switch (message.kind()) {
    case v1::Event::KIND_FALL:
      *message.mutable_failure() = failures_.Add(event, trial.id);
      break;
    case v1::Event::KIND_TRIAL:
    case v1::Event::KIND_TASK:
      *message.mutable_trial() = StateOf(trial, event.trial);
      if (!trial.id.empty()) message.set_text(message.text() + " (" + trial.id + ")");
      break;
    default:
      break;
  }
  return message;
}

std::vector<v1::Event> TrialControl::TakeCorrections(std::int64_t host_ns) {
  std::vector<v1::Event> events = failures_.TakeCorrections();
  for (v1::Event& event : events) event.set_host_ns(host_ns);
  return events;
}

void TrialControl::Describe(const Frame& frame, v1::Character& character) const {
  *character.mutable_trial() =
      StateOf(TrialNumbered(frame.output.trial_number), frame.output.trial);
  const stream::FailureCounts counted =
      stream::Without(frame.output.gait.failures, failures_.withdrawn());
  *character.mutable_gait()->mutable_failures() = wire::ToProto(counted);
  character.mutable_gait()->set_falls(stream::Total(counted));
}

}  // namespace footing::gait_service
