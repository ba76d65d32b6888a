#include "clients/view/app/recorded_show.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "clients/view/scene/text.h"
#include "common/base/units.h"
#include "common/recording/recording_server.h"
#include "common/rig/follower.h"
#include "common/wire/scalar.h"
#include "common/wire/wire.h"

namespace footing::view {
namespace {

using playback::PlacedTick;
using stream::TrialPhase;
using timeline::TrialMark;

/// Limit on gait changes, on responses and on notes.
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
      case v1::Event::KIND_MARKER:
        marks_.timeline.markers.push_back(
            {at_s, event.text(),
             event.marker().has_value() ? std::optional(event.marker().value()) : std::nullopt});
        return;
      case v1::Event::KIND_GAIT_CHANGED:  // There are as many of these as steps of a script.
      case v1::Event::KIND_RESPONSE:
        return;
      case v1::Event::KIND_PUT_BACK:  // Every failure has one; a person's own stands alone.
        if (event.by_operator()) marks_.timeline.events.push_back({at_s, event.text()});
        return;
      default:  // Kinds that a newer server adds are shown by their text, too.
        if (!event.text().empty()) marks_.timeline.events.push_back({at_s, event.text()});
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
    std::stable_sort(line.markers.begin(), line.markers.end(), earlier);
    std::stable_sort(line.events.begin(), line.events.end(), earlier);
    // Those of the second server come behind all of the first one.
    std::sort(marks_.notes_ns.begin(), marks_.notes_ns.end());
    // footing-sim's own trials say more; whoever leads trials there needs no markers for them.
    if (line.trials.empty()) line.trials = timeline::TrialsOf(line.markers);
    for (TrialMark& trial : line.trials) trial.begin_s = std::max(trial.begin_s, 0.0);
    return std::move(marks_);
  }

 private:
  double PositionOf(std::int64_t time_ns) const { return NanosecondsToSeconds(time_ns - zero_ns_); }

  bool IsFull() const {
    const timeline::Timeline& line = marks_.timeline;
    const std::size_t instants = std::max(
        {marks_.gait_changes_ns.size(), marks_.responses_ns.size(), marks_.notes_ns.size()});
    return std::max({line.trials.size(), line.failures.size(), line.tasks.size(),
                     line.markers.size(), line.events.size()}) >= timeline::kMostMarks ||
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
  for (std::size_t server = 0; server < PlayedServers().size(); ++server) {
    recording.Visit(server, "events",
                    [&collector](const PlacedTick& placed) { collector.OnTick(placed); });
  }
  if (collector.too_many()) {
    return InvalidData(recording.path() + ": too many events; at most " +
                       std::to_string(timeline::kMostMarks) + " of a kind are read");
  }
  TakeFrame(recording.LastOf(kPlayedSimulation, "characters", recording.last_ns()), collector);
  return collector.Take(recording.last_ns());
}

namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kStepNs = kSecond / 60;
/// Ticks are read in blocks of so much time.
constexpr std::int64_t kBlockNs = kSecond / 2;
/// Time that covers the strips, and after which the camera's slowest filter, 1.5 rad/s, has
/// forgotten where it started: (1 + wt) exp(-wt) is 3e-7 then.
constexpr std::int64_t kSeekNs = 12 * kSecond;
/// Where falls are shown again: the clip and its replay at a quarter of its pace.
constexpr std::int64_t kSeekWithReplaysNs = 40 * kSecond;
/// Farther ahead it is faster to seek.
constexpr std::int64_t kPlayOnNs = 3 * kSecond;
/// All states of a gait have come by then.
constexpr std::int64_t kGaitNs = 8 * kSecond;
/// As a live connection counts as stale.
constexpr std::int64_t kStaleNs = 3 * kSecond;

/// The last one at or before an instant; nothing when there is none.
std::optional<std::int64_t> LastBefore(const std::vector<std::int64_t>& times_ns,
                                       std::int64_t at_ns) {
  const auto after = std::upper_bound(times_ns.begin(), times_ns.end(), at_ns);
  if (after == times_ns.begin()) return std::nullopt;
  return *std::prev(after);
}

}  // namespace

RecordedShow::RecordedShow(playback::SeekableRecording recording, RecordedMarks marks)
    : recording_(std::move(recording)),
      marks_(std::move(marks)),
      show_(std::make_unique<scene::Show>()),
      newest_ns_(PlayedServers().size(), recording_.first_ns()) {}

std::int64_t RecordedShow::TimeOf(double position_s) const {
  return std::clamp(recording_.first_ns() + RoundToNanoseconds(position_s), recording_.first_ns(),
                    recording_.last_ns());
}

scene::Show::Shot RecordedShow::At(std::int64_t time_ns, const scene::StageOptions& options) {
  const bool ahead =
      stepped_to_ns_ != 0 && time_ns >= taken_to_ns_ - 1 && time_ns <= taken_to_ns_ + kPlayOnNs;
  if (!ahead) Seek(time_ns, options);
  PlayTo(time_ns + 1, true, options);
  ReportLinks(time_ns);
  return show_->Peek(time_ns, options);
}

void RecordedShow::Seek(std::int64_t time_ns, const scene::StageOptions& options) {
  track_version_ = std::max(track_version_, model().track_version);
  show_ = std::make_unique<scene::Show>();
  if (replays_falls_) show_->ReplayFalls();
  model().track_version = track_version_;
  const std::vector<Span> spans = SeekSpans(time_ns);
  taken_to_ns_ = spans.front().first;
  stepped_to_ns_ = 0;
  newest_ns_.assign(PlayedServers().size(), recording_.first_ns());
  ApplyRetained(taken_to_ns_);
  for (const Span& span : spans) {
    const bool last = &span == &spans.back();
    taken_to_ns_ = std::max(taken_to_ns_, span.first);
    if (last) {
      ApplyRetained(taken_to_ns_);
      ApplyLastNotes(taken_to_ns_);
      // Falls before belong to no clip: the frames that led to them are missing.
      model().replay = {};
    }
    PlayTo(span.second, last, options);
  }
}

/// Spans of the past that a scene shows, oldest first and disjoint: the last seconds; how the
/// present gait began, for the order of its states; and for each kind of data that has ceased, its
/// last seconds, since those stand still on the screen.
std::vector<RecordedShow::Span> RecordedShow::SeekSpans(std::int64_t time_ns) {
  const std::int64_t first_ns = recording_.first_ns();
  const std::int64_t seek_ns = replays_falls_ ? kSeekWithReplaysNs : kSeekNs;
  const std::int64_t start_ns = std::max(first_ns, time_ns - seek_ns);
  std::vector<Span> spans;
  const auto add = [&](std::int64_t from_ns, std::int64_t to_ns) {
    from_ns = std::max(from_ns, first_ns);
    to_ns = std::min(to_ns, start_ns);
    if (from_ns < to_ns) spans.emplace_back(from_ns, to_ns);
  };
  const std::int64_t gait_ns = LastBefore(marks_.gait_changes_ns, start_ns).value_or(first_ns);
  add(gait_ns - kSecond, gait_ns + kGaitNs);
  const auto ceased = [&](std::size_t server, const char* channel) {
    const auto last = recording_.LastOf(server, channel, time_ns);
    if (last) add(last->time_ns - seek_ns, last->time_ns + 1);
  };
  for (const char* channel : {"motion", "features", "boards", "hands", "reference"}) {
    ceased(kPlayedSensors, channel);
  }
  ceased(kPlayedSimulation, "characters");
  std::sort(spans.begin(), spans.end());
  std::vector<Span> joined;
  for (const Span& span : spans) {
    if (!joined.empty() && span.first <= joined.back().second) {
      joined.back().second = std::max(joined.back().second, span.second);
    } else {
      joined.push_back(span);
    }
  }
  joined.emplace_back(start_ns, time_ns);
  return joined;
}

void RecordedShow::ApplyRetained(std::int64_t time_ns) {
  for (std::size_t server = 0; server < PlayedServers().size(); ++server) {
    for (const char* channel : {"status", "setup", "skeletons", "track", "game"}) {
      const auto placed = recording_.LastOf(server, channel, time_ns - 1, true);
      if (!placed) continue;
      PlacedTick retained = *placed;
      retained.live = false;
      // A snapshot may be later than what it belongs to: it must not look like newer data.
      if (retained.time_ns > time_ns) retained.time_ns = time_ns;
      Take(retained);
    }
  }
}

void RecordedShow::ApplyLastNotes(std::int64_t before_ns) {
  for (const auto* times_ns : {&marks_.responses_ns, &marks_.notes_ns}) {
    const auto last_ns = LastBefore(*times_ns, before_ns - 1);
    if (!last_ns) continue;
    PlacedTick words;
    for (PlacedTick& placed : recording_.Ticks(*last_ns, *last_ns + 1)) {
      if (placed.tick.has_events()) words = std::move(placed);
    }
    v1::Events events = words.tick.events();
    words.tick.Clear();
    *words.tick.mutable_events() = std::move(events);
    words.live = false;
    Take(words);
  }
}

void RecordedShow::PlayTo(std::int64_t to_ns, bool steps, const scene::StageOptions& options) {
  while (taken_to_ns_ < to_ns) {
    const std::int64_t block_end_ns = std::min(to_ns, taken_to_ns_ + kBlockNs);
    const std::vector<PlacedTick> ticks = recording_.Ticks(taken_to_ns_, block_end_ns);
    std::size_t next = 0;
    const auto take_before = [&](std::int64_t end_ns) {
      for (; next < ticks.size() && ticks[next].time_ns < end_ns; ++next) {
        Take(ticks[next]);
        newest_ns_[ticks[next].server] = ticks[next].time_ns;
      }
    };
    if (steps) {
      // The first step behind what is taken already.
      const std::int64_t first_ns = recording_.first_ns();
      std::int64_t step_ns = first_ns + (taken_to_ns_ - first_ns + kStepNs - 1) / kStepNs * kStepNs;
      for (; step_ns < block_end_ns; step_ns += kStepNs) {
        take_before(step_ns + 1);
        show_->Step(step_ns, options);
        stepped_to_ns_ = step_ns;
      }
    }
    take_before(block_end_ns);
    taken_to_ns_ = block_end_ns;
  }
}

void RecordedShow::Take(const PlacedTick& placed) {
  scene::Update update =
      Translate(placed.tick, static_cast<int>(placed.server), placed.time_ns, placed.offset_ns);
  update.live = placed.live;
  update.host_ns = placed.time_ns;
  show_->Take(update, placed.time_ns + placed.delay_ns);
}

void RecordedShow::ReportLinks(std::int64_t time_ns) {
  std::vector<scene::LinkReport>& links = model().links;
  links.clear();
  for (std::size_t server = 0; server < PlayedServers().size(); ++server) {
    if (!recording_.Has(server)) continue;
    const std::string& name = PlayedServers()[server];
    links.push_back({recording_.path(), name, scene::LinkState::kLive, ""});
    if (time_ns - newest_ns_[server] > kStaleNs) {
      links.back().state = scene::LinkState::kStale;
      links.back().why = "the recording has no messages of " + name;
    }
  }
}

namespace {

constexpr int kMaxCharacters = 8;
constexpr int kMaxParts = 256;

using wire::Finite;

scene::ReferencePose ReferenceOf(const v1::ReferencePose& from, std::int64_t received_ns,
                                 std::int64_t offset_ns) {
  scene::ReferencePose reference;
  reference.received_ns = received_ns;
  reference.sampled_ns = from.sampled_ns() - offset_ns;
  for (int i = 0; i < std::min(from.positions_m_size(), kMaxParts); ++i) {
    reference.positions_m.push_back(wire::FromProto(from.positions_m(i)));
    reference.parents.push_back(i < from.parents_size() ? from.parents(i) : -1);
  }
  return reference;
}

scene::CharacterPose CharacterOf(const v1::Character& from) {
  scene::CharacterPose pose;
  pose.character = from.character();
  pose.rig = from.rig();
  pose.valid = from.valid();
  for (int i = 0; i < std::min(from.links_size(), kMaxParts); ++i) {
    pose.links.push_back(wire::FromProto(from.links(i)));
  }
  for (int i = 0; i < std::min(from.contacts_size(), kMaxParts); ++i) {
    pose.contacts.push_back(wire::FromProto(from.contacts(i)));
  }
  pose.com_m = wire::FromProto(from.com_m());
  pose.com_velocity_mps = wire::FromProto(from.com_velocity_mps());
  pose.gait = wire::FromProto(from.gait());
  pose.phase = from.gait().phase();
  pose.interface = wire::FromProto(from.interface());
  pose.simulated_input = from.simulated_input();
  if (from.has_body()) pose.body = wire::FromProto(from.body());
  if (from.has_trial()) pose.trial = wire::FromProto(from.trial());
  return pose;
}

scene::WorldFrame FrameOf(const v1::CharacterFrame& from, std::uint64_t sequence) {
  scene::WorldFrame frame;
  frame.sequence = sequence;
  frame.step = from.step();
  frame.time_s = Finite(from.time_s());
  frame.overruns = from.overruns();
  for (int i = 0; i < std::min(from.characters_size(), kMaxCharacters); ++i) {
    frame.characters.push_back(CharacterOf(from.characters(i)));
  }
  return frame;
}

scene::NoteKind KindOf(v1::Event::Kind kind) {
  switch (kind) {
    case v1::Event::KIND_FALL:
      return scene::NoteKind::kFall;
    case v1::Event::KIND_PUT_BACK:
      return scene::NoteKind::kPutBack;
    case v1::Event::KIND_GAIT_CHANGED:
      return scene::NoteKind::kGaitChanged;
    case v1::Event::KIND_RESPONSE:
      return scene::NoteKind::kResponse;
    case v1::Event::KIND_STREAM_LOST:
      return scene::NoteKind::kStreamLost;
    case v1::Event::KIND_STREAM_BACK:
      return scene::NoteKind::kStreamBack;
    default:  // Kinds that a newer server adds are shown by their text.
      return scene::NoteKind::kOther;
  }
}

void AddSimulation(const v1::Tick& tick, scene::Update& update) {
  if (tick.has_skeletons()) {
    update.skeletons.emplace();
    for (const auto& skeleton : tick.skeletons().skeletons()) {
      update.skeletons->push_back(wire::FromProto(skeleton));
    }
  }
  if (tick.has_track()) update.track = wire::FromProto(tick.track());
  if (tick.has_study()) update.study = wire::FromProto(tick.study());
  if (tick.has_game()) update.game = wire::FromProto(tick.game());
  if (tick.has_characters()) update.frame = FrameOf(tick.characters(), tick.sequence());
  for (const auto& event : tick.events().events()) {
    update.notes.push_back(
        {KindOf(event.kind()), event.host_ns(), event.text(), wire::FromProto(event.response())});
  }
}

}  // namespace

scene::Update Translate(const v1::Tick& tick, int source, std::int64_t received_ns,
                        std::int64_t offset_ns) {
  scene::Update update;
  static_cast<rig::Tick&>(update) = wire::SensorTick(tick);
  update.source = source;
  update.live = !tick.snapshot() && !tick.refilled();
  update.host_ns -= offset_ns;
  update.received_ns = received_ns;
  for (stream::MotionSample& sample : update.motion) sample.received_ns -= offset_ns;
  if (tick.reference().poses_size() > 0) {
    update.reference = ReferenceOf(*tick.reference().poses().rbegin(), received_ns, offset_ns);
  }
  AddSimulation(tick, update);
  return update;
}

scene::Update TranslateNotice(const v1::Notice& notice, int source, std::int64_t received_ns) {
  scene::Update update;
  update.source = source;
  update.live = false;
  update.received_ns = received_ns;
  update.notes.push_back({scene::NoteKind::kServer, received_ns, notice.text(), {}});
  return update;
}

}  // namespace footing::view
