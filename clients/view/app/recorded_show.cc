#include "clients/view/app/recorded_show.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>

#include "clients/view/app/translate.h"
#include "common/base/time.h"
#include "common/base/units.h"

namespace footing::view {
namespace {

using playback::PlacedTick;

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kStepNs = kSecond / 60;
/// Ticks are read in blocks of so much time.
constexpr std::int64_t kBlockNs = kSecond / 2;
/// What the strips show, and until the camera's slowest filter, 1.5 rad/s, has forgotten where it
/// started: (1 + wt) exp(-wt) is 3e-7 then.
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
  TakeRetained(taken_to_ns_);
  for (const Span& span : spans) {
    const bool last = &span == &spans.back();
    taken_to_ns_ = std::max(taken_to_ns_, span.first);
    if (last) {
      TakeRetained(taken_to_ns_);
      TakeLastNotes(taken_to_ns_);
      // Falls before belong to no clip: the frames that led to them are missing.
      model().replay = {};
    }
    PlayTo(span.second, last, options);
  }
}

/// What a scene shows of the past, oldest first and disjoint: the last seconds; how the present
/// gait began, for the order of its states; and for each kind of data that has ceased, its last
/// seconds, since those stand still on the screen.
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

void RecordedShow::TakeRetained(std::int64_t time_ns) {
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

void RecordedShow::TakeLastNotes(std::int64_t before_ns) {
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

}  // namespace footing::view
