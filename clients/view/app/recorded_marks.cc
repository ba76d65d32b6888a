#include "clients/view/app/recorded_marks.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "clients/view/scene/trial_text.h"
#include "common/recording/recorded_server.h"
#include "common/base/instant.h"
#include "common/base/units.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::view {
namespace {

using playback::PlacedTick;
using stream::TrialPhase;
using timeline::TrialMark;

/// Of gait changes, responses or notes.
constexpr std::size_t kMostInstants = 1'000'000;

stream::FailureCause CauseOf(v1::FailureCause cause) {
  for (const stream::FailureCause one : stream::kFailureCauses) {
    if (static_cast<int>(one) == static_cast<int>(cause)) return one;
  }
  return stream::FailureCause::kUnspecified;
}

/// Puts events together; they come by time.
class MarkCollector {
 public:
  explicit MarkCollector(std::int64_t zero_ns) : zero_ns_(zero_ns) {}

  /// A frame's trial: of a recording that begins or ends within one.
  void OnTrialState(const stream::TrialState& state, std::int64_t time_ns) {
    if (!scene::ShowsTrial(state)) return;
    const double at_s = PositionOf(time_ns);
    if (!Goes(state)) {
      if (IsOver(state)) return;  // Before the recording began: there is nothing to play.
      Begin(state, at_s);
      frame_only_ = true;
    }
    TrialMark& trial = marks_.timeline.trials.back();
    const stream::TrialProgress& progress = state.progress;
    if (!trial.start_s && progress.phase == TrialPhase::kRunning) {
      trial.start_s = at_s - progress.time_s;
    }
    Take(state, trial);
  }

  void OnEvent(const v1::Event& event, std::int64_t offset_ns) {
    if (!IsInstant(event.host_ns())) return;
    const double at_s = PositionOf(event.host_ns() - offset_ns);
    switch (event.kind()) {
      case v1::Event::KIND_TRIAL:
        return OnTrial(wire::FromProto(event.trial()), at_s);
      case v1::Event::KIND_TASK:
        marks_.timeline.tasks.push_back({at_s, event.trial().task()});
        return;
      case v1::Event::KIND_FALL:
        return OnFailure(event, at_s);
      case v1::Event::KIND_CORRECTION:
        return OnCorrection(event.failure());
      default:
        return;
    }
  }

  void OnTick(const PlacedTick& placed) {
    bool response = false, note = false, change = false;
    for (const v1::Event& event : placed.tick.events().events()) {
      too_many_ = too_many_ || IsFull();
      if (too_many_) return;
      OnEvent(event, placed.offset_ns);
      change = change || event.kind() == v1::Event::KIND_GAIT_CHANGED;
      response = response || event.kind() == v1::Event::KIND_RESPONSE;
      note = note || (event.kind() != v1::Event::KIND_RESPONSE && !event.text().empty());
    }
    if (change) marks_.gait_changes_ns.push_back(placed.time_ns);
    if (response) marks_.responses_ns.push_back(placed.time_ns);
    if (note) marks_.notes_ns.push_back(placed.time_ns);
  }

  bool too_many() const { return too_many_; }

  RecordedMarks Take(std::int64_t last_ns) {
    timeline::Timeline& line = marks_.timeline;
    line.end_s = PositionOf(last_ns);
    const auto earlier = [](const auto& a, const auto& b) { return a.at_s < b.at_s; };
    std::stable_sort(line.failures.begin(), line.failures.end(), earlier);
    std::stable_sort(line.tasks.begin(), line.tasks.end(), earlier);
    for (TrialMark& trial : line.trials) trial.begin_s = std::max(trial.begin_s, 0.0);
    return std::move(marks_);
  }

 private:
  double PositionOf(std::int64_t time_ns) const { return NanosecondsToSeconds(time_ns - zero_ns_); }

  bool IsFull() const {
    const timeline::Timeline& line = marks_.timeline;
    const std::size_t instants = std::max(
        {marks_.gait_changes_ns.size(), marks_.responses_ns.size(), marks_.notes_ns.size()});
    return std::max({line.trials.size(), line.failures.size(), line.tasks.size()}) >=
               timeline::kMostMarks ||
           instants >= kMostInstants;
  }

  static bool IsOver(const stream::TrialState& state) {
    return state.progress.phase == TrialPhase::kFinished ||
           state.progress.phase == TrialPhase::kStopped;
  }

  static void Take(const stream::TrialState& state, TrialMark& trial) {
    trial.track = state.track;
    trial.task = state.task;
    trial.phase = state.progress.phase;
    trial.time_s = state.progress.time_s;
  }

  /// The newest mark has this name.
  bool Goes(const stream::TrialState& state) const {
    const auto& trials = marks_.timeline.trials;
    return !trials.empty() && trials.back().id == state.trial &&
           trials.back().number == state.number;
  }

  void Begin(const stream::TrialState& state, double at_s) {
    TrialMark trial;
    trial.id = state.trial;
    trial.number = state.number;
    trial.begin_s = at_s;
    marks_.timeline.trials.push_back(trial);
  }

  /// The event begins a trial. A restarted server gives the same names and numbers again.
  bool Begins(const stream::TrialState& state, double at_s) const {
    if (!Goes(state)) return true;
    const TrialMark& newest = marks_.timeline.trials.back();
    if (state.progress.phase == TrialPhase::kRunning) return newest.end_s.has_value();
    if (state.progress.phase != TrialPhase::kReady) return false;
    const bool announced =
        frame_only_ && (newest.phase == TrialPhase::kReady || at_s <= newest.begin_s);
    return !announced;
  }

  void OnTrial(const stream::TrialState& state, double at_s) {
    if (!scene::ShowsTrial(state)) return;
    if (Begins(state, at_s)) Begin(state, at_s);
    frame_only_ = false;
    TrialMark& trial = marks_.timeline.trials.back();
    trial.begin_s = std::min(trial.begin_s, at_s);
    switch (state.progress.phase) {
      case TrialPhase::kRunning:
        trial.start_s = at_s - state.progress.time_s;
        break;
      case TrialPhase::kFinished:
      case TrialPhase::kStopped:
        if (!trial.start_s && state.progress.time_s > 0) {
          trial.start_s = at_s - state.progress.time_s;
        }
        trial.end_s = at_s;
        break;
      case TrialPhase::kReady:
      case TrialPhase::kUnspecified:
        break;
    }
    Take(state, trial);
  }

  void OnFailure(const v1::Event& event, double at_s) {
    const v1::Failure& failure = event.failure();
    timeline::FailureMark mark;
    mark.at_s = at_s;
    mark.number = failure.number();
    mark.cause = CauseOf(event.failure_cause());
    mark.trial = failure.trial();
    mark.trial_time_s = wire::Finite(failure.trial_time_s());
    mark.distance_m = wire::Finite(failure.distance_m());
    marks_.timeline.failures.push_back(std::move(mark));
  }

  void OnCorrection(const v1::Failure& failure) {
    auto& failures = marks_.timeline.failures;
    // A restarted server counts from 1 again: the newest one is meant.
    const auto found = std::find_if(failures.rbegin(), failures.rend(), [&](const auto& mark) {
      return mark.number == failure.number();
    });
    if (found != failures.rend()) found->withdrawn = failure.withdrawn();
  }

  std::int64_t zero_ns_;
  bool frame_only_ = false;  ///< The newest trial is known from a frame alone.
  bool too_many_ = false;    ///< An event was left out.
  RecordedMarks marks_;
};

/// The trial of the first character of a frame, into the collector.
void TakeFrame(const std::optional<PlacedTick>& placed, MarkCollector& collector) {
  if (!placed || placed->tick.characters().characters_size() == 0) return;
  const v1::Character& character = placed->tick.characters().characters(0);
  if (character.has_trial()) {
    collector.OnTrialState(wire::FromProto(character.trial()), placed->time_ns);
  }
}

}  // namespace

const std::vector<std::string>& PlayedServers() {
  static const std::vector<std::string> kNames{"footing-sim", "footingd"};
  return kNames;
}

Result<playback::SeekableRecording> OpenForPlayback(const std::string& path) {
  return playback::SeekableRecording::Open(
      path, PlayedServers(),
      {"status", "motion", "features", "boards", "skeletons", "track", "characters", "events",
       "setup", "reference", "game"});
}

Result<RecordedMarks> ReadMarks(playback::SeekableRecording& recording) {
  MarkCollector collector(recording.first_ns());
  TakeFrame(recording.LastOf(kPlayedSimulation, "characters", recording.first_ns(), true),
            collector);
  recording.Visit(kPlayedSimulation, "events",
                  [&collector](const PlacedTick& placed) { collector.OnTick(placed); });
  if (collector.too_many()) {
    return InvalidData(recording.path() + ": too many events; at most " +
                       std::to_string(timeline::kMostMarks) + " failures are read");
  }
  TakeFrame(recording.LastOf(kPlayedSimulation, "characters", recording.last_ns()), collector);
  return collector.Take(recording.last_ns());
}

}  // namespace footing::view
