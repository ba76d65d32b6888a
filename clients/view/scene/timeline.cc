#include "clients/view/scene/timeline.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "clients/view/scene/text.h"
#include "common/base/text.h"

namespace footing::timeline {
namespace {

constexpr double kSameS = 1e-3;
constexpr double kAfterEndS = 2;

/// Trials of one id differ by where they begin.
bool Same(const TrialMark& a, const TrialMark& b) {
  return a.number == b.number && a.begin_s == b.begin_s;
}

double EndOf(const Timeline& timeline, const TrialMark& trial) {
  double end_s = trial.end_s ? *trial.end_s + kAfterEndS : timeline.end_s;
  for (const TrialMark& other : timeline.trials) {
    if (other.begin_s > trial.begin_s) end_s = std::min(end_s, other.begin_s - kSameS);
  }
  return std::min(end_s, timeline.end_s);
}

/// It happened while the trial went on. Behind its end falls are still counted, but not for it.
bool IsOf(const Timeline& timeline, const FailureMark& failure, const TrialMark& trial) {
  const TrialMark* const at = TrialAt(timeline, failure.at_s);
  if (at == nullptr || !Same(*at, trial)) return false;
  if (trial.end_s && failure.at_s > *trial.end_s) return false;
  // Old recordings hold the cause alone.
  return failure.number == 0 || trial.id.empty() || failure.trial == trial.id;
}

std::string ListOf(const Timeline& timeline) {
  constexpr std::size_t kMostListed = 40;
  std::string list;
  for (std::size_t i = 0; i < std::min(timeline.trials.size(), kMostListed); ++i) {
    const TrialMark& trial = timeline.trials[i];
    list += (list.empty() ? "" : ", ") + NameOf(trial) + " (#" + std::to_string(trial.number) + ")";
  }
  return list + (timeline.trials.size() > kMostListed ? ", ..." : "");
}

}  // namespace

Timeline Shifted(Timeline timeline, double zero_s) {
  timeline.begin_s -= zero_s;
  timeline.end_s -= zero_s;
  for (FailureMark& failure : timeline.failures) failure.at_s -= zero_s;
  for (TaskMark& task : timeline.tasks) task.at_s -= zero_s;
  for (MarkerMark& marker : timeline.markers) marker.at_s -= zero_s;
  for (EventMark& event : timeline.events) event.at_s -= zero_s;
  for (TrialMark& trial : timeline.trials) {
    trial.begin_s -= zero_s;
    if (trial.start_s) *trial.start_s -= zero_s;
    if (trial.end_s) *trial.end_s -= zero_s;
  }
  return timeline;
}

std::vector<TrialMark> TrialsOf(const std::vector<MarkerMark>& markers) {
  constexpr std::string_view kBegin = "begin ", kEnd = "end ";
  std::vector<TrialMark> trials;
  for (const MarkerMark& marker : markers) {
    const std::string_view text = marker.text;
    if (text.starts_with(kBegin) && text.size() > kBegin.size()) {
      TrialMark trial;
      trial.id = text.substr(kBegin.size());
      trial.number = trials.size() + 1;
      trial.begin_s = marker.at_s;
      trial.start_s = marker.at_s;
      trial.phase = stream::TrialPhase::kRunning;
      trials.push_back(trial);
    } else if (text.starts_with(kEnd)) {
      const auto begun = std::find_if(trials.rbegin(), trials.rend(), [&](const TrialMark& trial) {
        return trial.id == text.substr(kEnd.size());
      });
      if (begun == trials.rend() || begun->end_s) continue;
      begun->end_s = marker.at_s;
      begun->phase = stream::TrialPhase::kFinished;
      begun->time_s = marker.at_s - begun->begin_s;
    }
  }
  return trials;
}

namespace {

/// Positions that the keys for failures go to, sorted.
std::vector<double> StopsOf(const Timeline& timeline) {
  std::vector<double> stops_s;
  for (const FailureMark& failure : timeline.failures) stops_s.push_back(failure.at_s);
  if (!stops_s.empty()) return stops_s;
  for (const EventMark& event : timeline.events) stops_s.push_back(event.at_s);
  for (const MarkerMark& marker : timeline.markers) stops_s.push_back(marker.at_s);
  std::sort(stops_s.begin(), stops_s.end());
  return stops_s;
}

}  // namespace

std::optional<double> NextFailure(const Timeline& timeline, double at_s) {
  for (const double stop_s : StopsOf(timeline)) {
    if (stop_s > at_s + kSameS) return stop_s;
  }
  return std::nullopt;
}

std::optional<double> PreviousFailure(const Timeline& timeline, double at_s) {
  std::optional<double> found;
  for (const double stop_s : StopsOf(timeline)) {
    if (stop_s < at_s - kSameS) found = stop_s;
  }
  return found;
}

std::optional<double> NextTrial(const Timeline& timeline, double at_s) {
  if (timeline.trials.empty()) return std::nullopt;
  for (const TrialMark& trial : timeline.trials) {
    if (trial.begin_s > at_s + kSameS) return trial.begin_s;
  }
  return timeline.trials.front().begin_s;
}

const TrialMark* TrialAt(const Timeline& timeline, double at_s) {
  const TrialMark* found = nullptr;
  for (const TrialMark& trial : timeline.trials) {
    if (trial.begin_s <= at_s + kSameS) found = &trial;
  }
  return found;
}

stream::FailureCounts FailuresOf(const Timeline& timeline, const TrialMark& trial, double until_s) {
  stream::FailureCounts counts;
  for (const FailureMark& failure : timeline.failures) {
    if (failure.withdrawn || failure.at_s > until_s || !IsOf(timeline, failure, trial)) continue;
    if (auto* const count = stream::MutableCountOf(failure.cause, counts)) ++*count;
  }
  return counts;
}

std::string NameOf(const TrialMark& trial) {
  return trial.id.empty() ? "trial " + std::to_string(trial.number) : trial.id;
}

Result<TrialMark> FindTrial(const Timeline& timeline, const std::string& name) {
  if (timeline.trials.empty()) {
    return InvalidData("the recording holds no trials; play it without --trial");
  }
  for (const TrialMark& trial : timeline.trials) {
    if (NameOf(trial) == name || "#" + std::to_string(trial.number) == name) return trial;
  }
  return UsageError("no trial " + name + " in the recording; there are: " + ListOf(timeline));
}

Timeline Only(const Timeline& timeline, const TrialMark& trial) {
  Timeline only;
  only.begin_s = trial.begin_s;
  only.end_s = std::max(trial.begin_s, EndOf(timeline, trial));
  const auto within = [&only](double at_s) { return at_s >= only.begin_s && at_s <= only.end_s; };
  for (const TrialMark& other : timeline.trials) {
    if (Same(other, trial)) only.trials.push_back(other);
  }
  for (const FailureMark& failure : timeline.failures) {
    if (within(failure.at_s)) only.failures.push_back(failure);
  }
  for (const TaskMark& task : timeline.tasks) {
    if (within(task.at_s)) only.tasks.push_back(task);
  }
  for (const MarkerMark& marker : timeline.markers) {
    if (within(marker.at_s)) only.markers.push_back(marker);
  }
  for (const EventMark& event : timeline.events) {
    if (within(event.at_s)) only.events.push_back(event);
  }
  return only;
}

PlayHead HeadAt(double begin_s, double end_s, double speed) {
  return {begin_s, std::max(begin_s, end_s), begin_s, speed, false};
}

PlayHead Sought(PlayHead head, double at_s) {
  head.at_s = std::clamp(at_s, head.begin_s, head.end_s);
  return head;
}

PlayHead Advanced(PlayHead head, double passed_s) {
  if (head.paused || passed_s <= 0) return head;
  return Sought(head, head.at_s + head.speed * passed_s);
}

double Faster(double speed) {
  for (const double one : kSpeeds) {
    if (one > speed) return one;
  }
  return kSpeeds.back();
}

double Slower(double speed) {
  double slower = kSpeeds.front();
  for (const double one : kSpeeds) {
    if (one < speed) slower = one;
  }
  return slower;
}

namespace {

constexpr double kStepS = 1;

PlayHead PausedAt(PlayHead head, double at_s) {
  head.paused = true;
  return Sought(head, at_s);
}

PlayHead AtSpeed(PlayHead head, double speed) {
  head.speed = speed;
  return head;
}

}  // namespace

std::optional<PlayAction> ActionOf(const char* key) {
  for (const PlayKey& one : kPlayKeys) {
    if (std::string_view(one.key) == key) return one.action;
  }
  return std::nullopt;
}

PlayHead Act(const PlayHead& head, PlayAction action, const Timeline& timeline, double frame_s) {
  switch (action) {
    case PlayAction::kPause: {
      // At the end it plays again from the beginning.
      PlayHead next = head.ended() ? Sought(head, head.begin_s) : head;
      next.paused = !head.ended() && !head.paused;
      return next;
    }
    case PlayAction::kBack:
      return Sought(head, head.at_s - kStepS);
    case PlayAction::kForward:
      return Sought(head, head.at_s + kStepS);
    case PlayAction::kFrameBack:
      return PausedAt(head, head.at_s - frame_s);
    case PlayAction::kFrameForward:
      return PausedAt(head, head.at_s + frame_s);
    case PlayAction::kFaster:
      return AtSpeed(head, Faster(head.speed));
    case PlayAction::kSlower:
      return AtSpeed(head, Slower(head.speed));
    case PlayAction::kNextFailure: {
      const auto at_s = NextFailure(timeline, head.at_s);
      return at_s ? PausedAt(head, *at_s) : head;
    }
    case PlayAction::kPreviousFailure: {
      const auto at_s = PreviousFailure(timeline, head.at_s);
      return at_s ? PausedAt(head, *at_s) : head;
    }
    case PlayAction::kNextTrial:
      return Sought(head, NextTrial(timeline, head.at_s).value_or(head.at_s));
    case PlayAction::kBegin:
      return Sought(head, head.begin_s);
    case PlayAction::kEnd:
      return Sought(head, head.end_s);
  }
  return head;
}

namespace {

template <typename Mark, typename Less>
std::vector<Mark> Merged(const std::vector<Mark>& a, const std::vector<Mark>& b, Less less) {
  std::vector<Mark> all = a;
  all.insert(all.end(), b.begin(), b.end());
  std::stable_sort(all.begin(), all.end(), less);
  return all;
}

}  // namespace

double ZeroOf(const Timeline& trial) {
  if (trial.trials.empty()) return trial.begin_s;
  return trial.trials.front().start_s.value_or(trial.trials.front().begin_s);
}

Result<std::array<double, 2>> ZerosOf(const std::array<Side, 2>& sides, Alignment alignment) {
  std::array<double, 2> zeros{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Timeline& timeline = sides[i].timeline;
    switch (alignment) {
      case Alignment::kStart:
        zeros[i] = ZeroOf(timeline);
        break;
      case Alignment::kFinish:
        if (timeline.trials.empty() || !timeline.trials.front().end_s) {
          return UsageError(
              "--align finish: a trial has no end in its recording; use --align start");
        }
        zeros[i] = *timeline.trials.front().end_s;
        break;
      case Alignment::kWall:
        if (!sides[i].wall_of_zero_ns) {
          return UsageError(
              "--align wall: a recording does not say its time of day; use --align start");
        }
        zeros[i] = sides[0].timeline.begin_s;
        if (i == 1) {
          zeros[i] +=
              1e-9 * static_cast<double>(*sides[0].wall_of_zero_ns - *sides[1].wall_of_zero_ns);
        }
        break;
    }
  }
  return zeros;
}

SideState SideAt(const Timeline& side, double at_s) {
  return {std::clamp(at_s, side.begin_s, std::max(side.begin_s, side.end_s)), at_s < side.begin_s,
          at_s >= side.end_s};
}

Timeline Joined(const Timeline& first, const Timeline& second) {
  Timeline joined;
  joined.begin_s = std::min(first.begin_s, second.begin_s);
  joined.end_s = std::max(first.end_s, second.end_s);
  const auto earlier = [](const auto& a, const auto& b) { return a.at_s < b.at_s; };
  joined.failures = Merged(first.failures, second.failures, earlier);
  joined.tasks = Merged(first.tasks, second.tasks, earlier);
  joined.markers = Merged(first.markers, second.markers, earlier);
  joined.events = Merged(first.events, second.events, earlier);
  joined.trials = Merged(first.trials, second.trials, [](const TrialMark& a, const TrialMark& b) {
    return a.begin_s < b.begin_s;
  });
  return joined;
}

namespace {

constexpr std::int64_t kTenthsAMinute = 600;
constexpr std::int64_t kMinutesAnHour = 60;

std::string TwoDigits(std::int64_t value) {
  return (value < 10 ? "0" : "") + std::to_string(value);
}

std::string FailureText(const FailureMark& failure) {
  return std::string("failure: ") + stream::Name(failure.cause) + ", at " +
         scene::Fixed(failure.distance_m, 1) + " m" + (failure.withdrawn ? ", withdrawn" : "");
}

}  // namespace

std::string ClockText(double seconds) {
  const std::int64_t tenths = std::llround(std::abs(seconds) * 10);
  const std::int64_t minutes = tenths / kTenthsAMinute;
  const std::int64_t rest = tenths % kTenthsAMinute;
  std::string text = seconds < 0 && tenths > 0 ? "-" : "";
  if (minutes >= kMinutesAnHour) {
    text += std::to_string(minutes / kMinutesAnHour) + ":" + TwoDigits(minutes % kMinutesAnHour);
  } else {
    text += std::to_string(minutes);
  }
  return text + ":" + TwoDigits(rest / 10) + "." + std::to_string(rest % 10);
}

std::string PositionText(const PlayHead& head) {
  std::string text = ClockText(head.at_s) + " of " + ClockText(head.end_s);
  if (head.speed != 1) text += "   speed " + text::Shortest(head.speed);
  if (head.ended()) return text + "   end";
  return text + (head.paused ? "   paused" : "");
}

std::string TrialText(const Timeline& timeline, double at_s) {
  const TrialMark* const trial = TrialAt(timeline, at_s);
  if (trial == nullptr) return "";
  const stream::FailureCounts counts = FailuresOf(timeline, *trial, at_s);
  const std::string name = trial->id.empty() ? NameOf(*trial) : "trial " + trial->id;
  return name + "   failed attempts " + std::to_string(stream::Total(counts)) +
         scene::CauseText(counts);
}

std::string StateText(const SideState& state) {
  if (state.finished) return "ended";
  return state.before ? "not begun" : "";
}

std::vector<MarkText> MarkTexts(const Timeline& timeline) {
  std::vector<MarkText> marks;
  for (const TrialMark& trial : timeline.trials) {
    const std::string name = trial.id.empty() ? NameOf(trial) : "trial " + trial.id;
    marks.emplace_back(trial.begin_s,
                       name + " ready" + (trial.track.empty() ? "" : ", track " + trial.track));
    if (trial.start_s) marks.emplace_back(*trial.start_s, name + " crosses the start line");
    if (trial.end_s) {
      marks.emplace_back(*trial.end_s, name + " " + stream::Name(trial.phase) + ", " +
                                           scene::Fixed(trial.time_s, 2) + " s");
    }
  }
  for (const FailureMark& failure : timeline.failures) {
    marks.emplace_back(failure.at_s, FailureText(failure));
  }
  for (const TaskMark& task : timeline.tasks) {
    marks.emplace_back(task.at_s, "task " + task.task + " done");
  }
  for (const MarkerMark& marker : timeline.markers) {
    marks.emplace_back(marker.at_s,
                       "marker: " + marker.text +
                           (marker.value ? " (" + text::Shortest(*marker.value) + ")" : ""));
  }
  for (const EventMark& event : timeline.events) marks.emplace_back(event.at_s, event.text);
  std::stable_sort(marks.begin(), marks.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return marks;
}

std::vector<std::string> MarkLines(const Timeline& timeline) {
  std::vector<std::string> lines;
  for (const auto& [at_s, what] : MarkTexts(timeline)) {
    lines.push_back(ClockText(at_s) + "  " + what);
  }
  return lines;
}

std::string TextAt(const Timeline& timeline, double at_s, double within_s) {
  const MarkText* nearest = nullptr;
  const std::vector<MarkText> marks = MarkTexts(timeline);
  for (const MarkText& mark : marks) {
    const double away_s = std::abs(mark.first - at_s);
    if (away_s > within_s) continue;
    if (nearest == nullptr || away_s < std::abs(nearest->first - at_s)) nearest = &mark;
  }
  return nearest == nullptr ? ClockText(at_s) : ClockText(nearest->first) + "  " + nearest->second;
}

}  // namespace footing::timeline
