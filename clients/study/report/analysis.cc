#include "clients/study/report/analysis.h"

#include <algorithm>

#include "common/text/number.h"

namespace footing::study::report {
namespace {

using nlohmann::ordered_json;

ordered_json Tested(const statistics::StudyTable& table, statistics::TestKind test,
                    std::uint64_t seed) {
  statistics::AnalysisRequest request;
  request.test = test;
  request.seed = seed;
  auto report = statistics::Analyze(table, request);
  if (report) return std::move(*report);
  return {{"test", statistics::NameOf(test)}, {"error", report.error().message}};
}

/// At least one other interface beside the control, and two values.
bool Comparable(const statistics::StudyTable& table, const std::string& control) {
  return table.groups.size() > 1 && table.groups.front().name == control;
}

ordered_json Groups(const statistics::StudyTable& table) {
  ordered_json groups = ordered_json::array();
  for (const statistics::Group& group : table.groups) {
    std::vector<double> sorted = group.values;
    std::sort(sorted.begin(), sorted.end());
    const std::size_t n = sorted.size();
    double sum = 0;
    for (const double value : sorted) sum += value;
    groups.push_back({{"interface", group.name},
                      {"n", n},
                      {"mean", sum / static_cast<double>(n)},
                      {"median", (sorted[(n - 1) / 2] + sorted[n / 2]) / 2},
                      {"least", sorted.front()},
                      {"greatest", sorted.back()}});
  }
  return groups;
}

/// RFC 4180.
std::string Cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people) {
  Analysis analysis;
  analysis.measures = Measures(protocol, people);
  std::size_t withdrawn = 0, unfinished = 0;
  for (const records::Records& person : people) {
    withdrawn += person.withdrawn ? 1 : 0;
    unfinished += !person.finished && !person.withdrawn ? 1 : 0;
    analysis.synthetic = analysis.synthetic || (person.synthetic && !person.withdrawn);
  }
  ordered_json measures = ordered_json::array();
  for (const Measure& measure : analysis.measures) {
    const statistics::StudyTable table = TableOf(measure, protocol);
    ordered_json one = {{"id", measure.id}, {"title", measure.title}, {"groups", Groups(table)}};
    if (Comparable(table, protocol.control)) {
      one["test"] = Tested(table, measure.test, protocol.seed);
      if (table.blocks) {
        one["paired"] = Tested(table, statistics::TestKind::kPaired, protocol.seed);
      }
    }
    measures.push_back(std::move(one));
  }
  analysis.json = {{"name", protocol.name},         {"control", protocol.control},
                   {"participants", people.size()}, {"withdrawn", withdrawn},
                   {"unfinished", unfinished},      {"synthetic", analysis.synthetic},
                   {"measures", measures}};
  return analysis;
}

std::string ValuesCsv(const Analysis& analysis) {
  std::string csv = "measure,participant,interface,value\n";
  for (const Measure& measure : analysis.measures) {
    for (const Value& one : measure.values) {
      csv += Cell(measure.id) + "," + Cell(one.participant) + "," + Cell(one.interface) + "," +
             text::Shortest(one.value) + "\n";
    }
  }
  return csv;
}

}  // namespace footing::study::report
