#include "clients/study/report/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "clients/study/report/latency.h"
#include "common/statistics/quantile.h"
#include "common/stream/trial.h"
#include "common/base/units.h"

namespace footing::study::report {
namespace {

using records::Records;
using records::Trial;
using statistics::TestKind;
using Trials = std::vector<const Trial*>;

constexpr double kSecondsPerMinute = 60;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A value from the trials that a participant made with an interface; NaN: none.
using FromTrials = std::function<double(const Trials&)>;

double TimeS(const Trials& trials) {
  double time_s = 0;
  for (const Trial* trial : trials) time_s += trial->time_s;
  return time_s;
}

/// The mean of a figure over the trials that have it.
double Mean(const Trials& trials, double Trial::*figure) {
  double sum = 0;
  std::size_t count = 0;
  for (const Trial* trial : trials) {
    if (!std::isfinite(trial->*figure)) continue;
    sum += trial->*figure;
    ++count;
  }
  return count == 0 ? kNone : sum / static_cast<double>(count);
}

/// NaN unless all of them reached the finish line.
double CompletionS(const Trials& trials) {
  for (const Trial* trial : trials) {
    if (trial->outcome != "finished") return kNone;
  }
  return TimeS(trials) / static_cast<double>(trials.size());
}

std::size_t FailuresIn(const Trials& trials) {
  std::size_t failures = 0;
  for (const Trial* trial : trials) failures += trial->failure_count();
  return failures;
}

double MeanTimeToFailureS(const Trials& trials) {
  const std::size_t failures = FailuresIn(trials);
  const double time_s = TimeS(trials);
  return time_s > 0 ? time_s / static_cast<double>(std::max<std::size_t>(1, failures)) : kNone;
}

double LatencyMs(const Trials& trials) {
  std::vector<double> times_ms;
  for (const Trial* trial : trials) {
    for (const records::Response& one : trial->responses) times_ms.push_back(WithoutContactMs(one));
  }
  return times_ms.empty() ? kNone : statistics::MedianOf(std::move(times_ms));
}

/// Makes the measures of trials, one after the other.
class TrialMeasures {
 public:
  TrialMeasures(const plan::Protocol& protocol, const std::vector<Records>& people)
      : planned_{{"straight", protocol.straight_trials}, {"test_track", 1}} {
    for (const Records& person : people) {
      const auto counting = records::Counting(person);
      for (const std::string& interface : protocol.interfaces) {
        for (const Trial* trial : counting) {
          if (trial->interface != interface) continue;
          trials_[{person.participant, interface, trial->kind}].push_back(trial);
          trials_[{person.participant, interface, ""}].push_back(trial);
        }
      }
    }
  }

  /// `kind` is "straight" or "test_track"; empty: both.
  void Add(const std::string& kind, Measure measure, const FromTrials& from) {
    for (const auto& [key, trials] : trials_) {
      if (std::get<2>(key) != kind) continue;
      const double value = from(trials);
      const double exposure_min = TimeS(trials) / kSecondsPerMinute;
      const bool whole = trials.size() >= Planned(kind) && exposure_min > 0;
      if (!std::isfinite(value) || (measure.counts && !whole)) continue;
      const bool censored = measure.times_to_failure && FailuresIn(trials) == 0;
      measure.values.push_back({std::get<0>(key), std::get<1>(key), value, exposure_min, censored});
    }
    list.push_back(std::move(measure));
  }

  /// Failures by kind, and all together.
  void AddFailures(const std::string& kind, const std::string& id, const std::string& where) {
    const auto add = [&](const std::string& name, const std::string& title, const auto& count_of) {
      Add(kind,
          {Section::kFailures,
           id + "_failures_" + name,
           where + ", " + title,
           TestKind::kSteel,
           {},
           /*counts=*/true},
          [&count_of](const Trials& trials) {
            double count = 0;
            for (const Trial* trial : trials) count += static_cast<double>(count_of(*trial));
            return count;
          });
    };
    add("all", "failures of every kind", [](const Trial& trial) { return trial.failure_count(); });
    for (const stream::FailureCause cause : stream::kFailureCauses) {
      const std::string name = stream::Name(cause);
      add(name, "failures of kind " + name, [&](const Trial& trial) { return trial.Count(name); });
    }
  }

  std::vector<Measure> list;

 private:
  std::size_t Planned(const std::string& kind) const {
    const auto found = planned_.find(kind);
    return found == planned_.end() ? 0 : found->second;
  }

  std::map<std::string, std::size_t> planned_;  ///< Trials of a kind with each interface.
  /// By participant, interface and kind.
  std::map<std::tuple<std::string, std::string, std::string>, Trials> trials_;
};

/// Of each interface: right after it, and at the end.
std::vector<Measure> OfRatings(const std::vector<Records>& people) {
  std::vector<Measure> measures;
  std::map<std::string, std::size_t> index;
  for (const Records& person : people) {
    for (const records::Rating& rating : person.ratings) {
      if (rating.interface.empty()) continue;
      const std::string id = (rating.at_end ? "final_rating " : "rating ") + rating.item;
      const bool exertion = rating.item == plan::kExertionItem;
      if (index.emplace(id, measures.size()).second) {
        measures.push_back({Section::kSurvey,
                            id,
                            rating.item + (rating.at_end ? ", at the end" : "") +
                                (exertion ? ", 0 to 10" : ", rating 1 to 5"),
                            TestKind::kSteel,
                            {}});
      }
      measures[index.at(id)].values.push_back({rating.participant, rating.interface, rating.value});
    }
  }
  return measures;
}

Measure OfActiveTime(const std::vector<Records>& people) {
  Measure measure{Section::kSurvey, "active_min", "Time in motion, minutes", TestKind::kSteel, {}};
  measure.zeros_unmeasured = true;  // The controllers of a joystick and boards are not body-worn.
  for (const Records& person : people) {
    for (const auto& [interface, active_s] : person.active_s) {
      measure.values.push_back({person.participant, interface, active_s / kSecondsPerMinute});
    }
  }
  return measure;
}

}  // namespace

const char* Title(Section section) {
  switch (section) {
    case Section::kControl:
      return "Completion and control";
    case Section::kFailures:
      return "Failures";
    case Section::kLatency:
      return "Latency and anticipation";
    case Section::kSurvey:
      return "Survey and effort";
  }
  return "";
}

std::vector<double> Measure::Of(const std::string& interface) const {
  std::vector<double> found;
  for (const Value& one : values) {
    if (one.interface == interface) found.push_back(one.value);
  }
  return found;
}

std::size_t Measure::censored(const std::string& interface) const {
  return static_cast<std::size_t>(
      std::count_if(values.begin(), values.end(),
                    [&](const Value& one) { return one.censored && one.interface == interface; }));
}

bool Measure::all_zero() const {
  return std::all_of(values.begin(), values.end(), [](const Value& one) { return one.value == 0; });
}

std::vector<Measure> Measures(const plan::Protocol& protocol, const std::vector<Records>& all) {
  std::vector<Records> people;
  for (const Records& person : all) {
    if (!person.withdrawn) people.push_back(person);
  }
  TrialMeasures measures(protocol, people);
  measures.Add("test_track",
               {Section::kControl,
                "test_time_to_completion_s",
                "Test track, time to completion, s",
                TestKind::kSteel,
                {}},
               CompletionS);
  measures.Add("test_track",
               {Section::kControl,
                "test_mean_time_to_failure_s",
                "Test track, mean time to failure, s",
                TestKind::kSteel,
                {},
                /*counts=*/false,
                /*times_to_failure=*/true},
               MeanTimeToFailureS);
  measures.Add("straight",
               {Section::kControl,
                "straight_oscillation_deg",
                "Straight tracks, oscillation of heading, degrees",
                TestKind::kDunnett,
                {}},
               [](const Trials& trials) {
                 return RadiansToDegrees(Mean(trials, &Trial::heading_oscillation_rad));
               });
  measures.AddFailures("straight", "straight", "Straight tracks");
  measures.AddFailures("test_track", "test", "Test track");
  measures.Add("",
               {Section::kLatency,
                "latency_without_contact_ms",
                "Latency without the wait for contact, median, ms",
                TestKind::kSteel,
                {}},
               LatencyMs);
  measures.Add("straight",
               {Section::kLatency,
                "anticipation_s",
                "Command before the line of the task, s",
                TestKind::kSteel,
                {}},
               [](const Trials& trials) { return Mean(trials, &Trial::anticipation_s); });
  measures.list.push_back(OfActiveTime(people));
  for (Measure& rating : OfRatings(people)) measures.list.push_back(std::move(rating));
  std::erase_if(measures.list, [](const Measure& one) { return one.values.empty(); });
  return std::move(measures.list);
}

}  // namespace footing::study::report
