#include "clients/view/scene/align.h"

#include <algorithm>

namespace footing::timeline {
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
  joined.trials = Merged(first.trials, second.trials, [](const TrialMark& a, const TrialMark& b) {
    return a.begin_s < b.begin_s;
  });
  return joined;
}

}  // namespace footing::timeline
