#include "clients/study/report/analysis.h"

#include <algorithm>
#include <set>
#include <utility>

#include "clients/study/report/figure.h"
#include "clients/study/report/measure_table.h"
#include "clients/study/report/notes.h"
#include "common/base/number.h"

namespace footing::study::report {
namespace {

using nlohmann::ordered_json;

ordered_json Tested(const statistics::StudyTable& table, statistics::TestKind test,
                    const TestOptions& options) {
  statistics::AnalysisRequest request;
  request.test = test;
  request.alternative = options.alternative;
  if (test == statistics::TestKind::kSteel) {
    request.ties = options.ties;
    request.method = options.method;
  }
  request.seed = options.seed.value_or(1);
  auto report = statistics::Analyze(table, request);
  if (report) return std::move(*report);
  return {{"test", statistics::NameOf(test)}, {"error", report.error().message}};
}

/// At least one other interface beside the control, and two values.
bool Comparable(const statistics::StudyTable& table, const std::string& control) {
  return table.groups.size() > 1 && table.groups.front().name == control;
}

ordered_json Groups(const Measure& measure, const plan::Protocol& protocol) {
  ordered_json groups = ordered_json::array();
  for (const statistics::Group& group : TableOf(measure, protocol).groups) {
    const auto [least, greatest] = std::minmax_element(group.values.begin(), group.values.end());
    double sum = 0;
    for (const double value : group.values) sum += value;
    groups.push_back({{"interface", group.name},
                      {"n", group.values.size()},
                      {"mean", sum / static_cast<double>(group.values.size())},
                      {"median", QuartilesOf(group.values).median},
                      {"least", *least},
                      {"greatest", *greatest}});
    if (measure.times_to_failure) groups.back()["censored"] = measure.censored(group.name);
  }
  return groups;
}

ordered_json ToJson(const TestOptions& options) {
  return {{"alternative", NameOf(options.alternative)},
          {"ties", NameOf(options.ties)},
          {"method", options.method ? ordered_json(NameOf(*options.method)) : ordered_json()},
          {"seed", options.seed.value_or(1)}};
}

/// A measure with its groups and tests.
ordered_json ToJson(const Measure& measure, const plan::Protocol& protocol,
                    const TestOptions& options) {
  const statistics::StudyTable table = TableOf(Measured(measure), protocol);
  ordered_json one = {
      {"id", measure.id}, {"title", measure.title}, {"groups", Groups(measure, protocol)}};
  if (std::string note = NoteOn(measure, protocol); !note.empty()) one["note"] = std::move(note);
  std::set<std::string> participants;
  for (const Value& value : measure.values) participants.insert(value.participant);
  one["participants"] = participants.size();
  if (!Comparable(table, protocol.control)) return one;
  one["test"] = Tested(table, measure.test, options);
  if (table.blocks) {
    one["paired_participants"] = table.blocks->subjects.size();
    one["paired"] = Tested(table, statistics::TestKind::kPaired, options);
  }
  if (measure.id.ends_with("_failures_all") && !measure.all_zero()) {
    one["rate"] = Tested(RateTableOf(measure, protocol), statistics::TestKind::kRate, options);
  }
  return one;
}

/// RFC 4180.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people,
                 const TestOptions& given) {
  TestOptions options = given;
  if (!options.seed) options.seed = protocol.seed;
  Analysis analysis;
  analysis.measures = Measures(protocol, people);
  std::size_t withdrawn = 0, unfinished = 0;
  for (const records::Records& person : people) {
    withdrawn += person.withdrawn ? 1 : 0;
    unfinished += !person.finished && !person.withdrawn ? 1 : 0;
    analysis.synthetic = analysis.synthetic || (person.synthetic && !person.withdrawn);
    analysis.simulated_time =
        analysis.simulated_time || (person.simulated_time && !person.withdrawn);
  }
  ordered_json measures = ordered_json::array();
  for (const Measure& measure : analysis.measures) {
    measures.push_back(ToJson(measure, protocol, options));
  }
  analysis.latency = LatencyByStage(InOrder(protocol), people);
  ordered_json latency = ordered_json::array();
  for (const StageLatency& one : analysis.latency) {
    latency.push_back({{"interface", one.interface},
                       {"stage", one.stage},
                       {"n", one.responses},
                       {"p50_ms", one.p50_ms},
                       {"p95_ms", one.p95_ms}});
  }
  analysis.json = {{"name", protocol.name},
                   {"control", protocol.control},
                   {"participants", people.size()},
                   {"withdrawn", withdrawn},
                   {"unfinished", unfinished},
                   {"synthetic", analysis.synthetic},
                   {"simulated_time", analysis.simulated_time},
                   {"tests", ToJson(options)},
                   {"measures", measures},
                   {"latency", latency}};
  return analysis;
}

std::string ValuesCsv(const Analysis& analysis) {
  std::string csv = "measure,plotted,participant,interface,value\n";
  const auto add = [&csv](const std::string& measure, const char* plotted,
                          const std::string& participant, const std::string& interface,
                          double value) {
    csv += Cell(measure) + "," + plotted + "," + Cell(participant) + "," + Cell(interface) + "," +
           text::Shortest(value) + "\n";
  };
  for (const Measure& measure : analysis.measures) {
    std::set<std::string> interfaces;
    for (const Value& one : measure.values) {
      add(measure.id, "point", one.participant, one.interface, one.value);
      interfaces.insert(one.interface);
    }
    for (const std::string& interface : interfaces) {
      const Quartiles box = QuartilesOf(measure.Of(interface));
      add(measure.id, "lower_quartile", "", interface, box.low);
      add(measure.id, "median", "", interface, box.median);
      add(measure.id, "upper_quartile", "", interface, box.high);
    }
  }
  for (const StageLatency& one : analysis.latency) {
    if (one.stage == kWhole) {
      add("latency_whole_ms", "label", "", one.interface, one.p50_ms);
    } else if (IsBar(one)) {
      add("latency_" + one.stage + "_ms", "bar", "", one.interface, one.p50_ms);
    }
  }
  return csv;
}

}  // namespace footing::study::report
