#include "clients/view/scene/timeline.h"

#include <algorithm>

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
  for (TrialMark& trial : timeline.trials) {
    trial.begin_s -= zero_s;
    if (trial.start_s) *trial.start_s -= zero_s;
    if (trial.end_s) *trial.end_s -= zero_s;
  }
  return timeline;
}

std::optional<double> NextFailure(const Timeline& timeline, double at_s) {
  for (const FailureMark& failure : timeline.failures) {
    if (failure.at_s > at_s + kSameS) return failure.at_s;
  }
  return std::nullopt;
}

std::optional<double> PreviousFailure(const Timeline& timeline, double at_s) {
  std::optional<double> found;
  for (const FailureMark& failure : timeline.failures) {
    if (failure.at_s < at_s - kSameS) found = failure.at_s;
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
  return only;
}

}  // namespace footing::timeline
