#include "clients/study/report/measures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "common/stream/trial.h"

namespace footing::study::report {
namespace {

using records::Records;
using records::Trial;

/// A value from the trials of one kind that a participant made with an interface; NaN: none.
using FromTrials = std::function<double(const std::vector<const Trial*>&)>;

Measure OfTrials(const plan::Protocol& protocol, const std::vector<Records>& people,
                 const std::string& kind, Measure measure, const FromTrials& from) {
  for (const Records& person : people) {
    const auto counting = records::Counting(person);
    for (const std::string& interface : protocol.interfaces) {
      std::vector<const Trial*> own;
      for (const Trial* trial : counting) {
        if (trial->interface == interface && trial->kind == kind) own.push_back(trial);
      }
      const double value = own.empty() ? std::nan("") : from(own);
      if (std::isfinite(value)) measure.values.push_back({person.participant, interface, value});
    }
  }
  return measure;
}

FromTrials CountOf(const std::string& failure) {
  return [failure](const std::vector<const Trial*>& trials) {
    double count = 0;
    for (const Trial* trial : trials) count += static_cast<double>(trial->Count(failure));
    return count;
  };
}

/// NaN unless all of them reached the finish line.
double CompletionS(const std::vector<const Trial*>& trials) {
  double sum_s = 0;
  for (const Trial* trial : trials) {
    if (trial->outcome != "finished") return std::nan("");
    sum_s += trial->time_s;
  }
  return sum_s / static_cast<double>(trials.size());
}

double MeanTimeToFailureS(const std::vector<const Trial*>& trials) {
  double time_s = 0;
  std::size_t failures = 0;
  for (const Trial* trial : trials) {
    time_s += trial->time_s;
    failures += trial->failure_count();
  }
  return time_s / static_cast<double>(std::max<std::size_t>(1, failures));
}

double OscillationDeg(const std::vector<const Trial*>& trials) {
  double sum_rad = 0;
  for (const Trial* trial : trials) sum_rad += trial->heading_oscillation_rad;
  return sum_rad / static_cast<double>(trials.size()) * 180 / std::acos(-1.0);
}

std::vector<Measure> OfRatings(const std::vector<Records>& people) {
  std::vector<Measure> measures;
  std::map<std::string, std::size_t> index;
  for (const Records& person : people) {
    for (const records::Rating& rating : person.ratings) {
      if (rating.interface.empty()) continue;
      const std::string id = "rating " + rating.item;
      const bool exertion = rating.item == "exertion";
      if (index.emplace(id, measures.size()).second) {
        measures.push_back({id,
                            rating.item + (exertion ? ", 0 to 10" : ", rating 1 to 5"),
                            statistics::TestKind::kSteel,
                            {}});
      }
      Measure& measure = measures[index.at(id)];
      measure.values.push_back({person.participant, rating.interface, rating.value});
    }
  }
  return measures;
}

}  // namespace

std::vector<double> Measure::Of(const std::string& interface) const {
  std::vector<double> found;
  for (const Value& one : values) {
    if (one.interface == interface) found.push_back(one.value);
  }
  return found;
}

std::vector<Measure> Measures(const plan::Protocol& protocol, const std::vector<Records>& all) {
  using statistics::TestKind;
  std::vector<Records> people;
  for (const Records& person : all) {
    if (!person.withdrawn) people.push_back(person);
  }
  std::vector<Measure> measures;
  const auto add = [&](const std::string& kind, const std::string& id, const std::string& title,
                       TestKind test, const FromTrials& from) {
    measures.push_back(OfTrials(protocol, people, kind, {id, title, test, {}}, from));
  };
  for (const stream::FailureCause cause : stream::kFailureCauses) {
    const std::string name = stream::Name(cause);
    const std::string title = "failures of kind " + name;
    add("straight", "straight_failures_" + name, "Straight tracks, " + title, TestKind::kSteel,
        CountOf(name));
    add("test_track", "test_failures_" + name, "Test track, " + title, TestKind::kSteel,
        CountOf(name));
  }
  add("straight", "straight_oscillation_deg", "Straight tracks, oscillation of heading, degrees",
      TestKind::kDunnett, OscillationDeg);
  add("test_track", "test_time_to_completion_s", "Test track, time to completion, s",
      TestKind::kSteel, CompletionS);
  add("test_track", "test_mean_time_to_failure_s", "Test track, mean time to failure, s",
      TestKind::kSteel, MeanTimeToFailureS);
  for (Measure& rating : OfRatings(people)) measures.push_back(std::move(rating));
  std::erase_if(measures, [](const Measure& one) { return one.values.empty(); });
  return measures;
}

statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol) {
  statistics::StudyTable table;
  std::vector<std::string> names = {protocol.control};
  for (const std::string& interface : protocol.interfaces) {
    if (interface != protocol.control) names.push_back(interface);
  }
  std::vector<std::string> kept;
  for (const std::string& name : names) {
    std::vector<double> values = measure.Of(name);
    if (values.empty()) continue;
    kept.push_back(name);
    table.exposures.emplace_back(values.size(), 1.0);
    table.groups.push_back({name, std::move(values)});
  }
  std::map<std::string, std::map<std::string, double>> by_person;
  for (const Value& one : measure.values) by_person[one.participant][one.interface] = one.value;
  statistics::Blocks blocks;
  blocks.groups = kept;
  for (const auto& [participant, values] : by_person) {
    if (values.size() != kept.size()) return table;
    blocks.subjects.push_back(participant);
    std::vector<double>& row = blocks.values.emplace_back();
    for (const std::string& name : kept) row.push_back(values.at(name));
  }
  table.blocks = std::move(blocks);
  return table;
}

}  // namespace footing::study::report
