#include "clients/view/scene/timeline_text.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/view/scene/words.h"
#include "common/base/number.h"

namespace footing::timeline {
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

std::vector<std::string> MarkLines(const Timeline& timeline) {
  std::vector<std::pair<double, std::string>> marks;
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
  std::stable_sort(marks.begin(), marks.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> lines;
  for (const auto& [at_s, what] : marks) lines.push_back(ClockText(at_s) + "  " + what);
  return lines;
}

}  // namespace footing::timeline
