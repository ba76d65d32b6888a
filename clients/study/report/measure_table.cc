#include "clients/study/report/measure_table.h"

#include <algorithm>
#include <map>
#include <utility>

namespace footing::study::report {

Measure Measured(const Measure& measure) {
  Measure measured = measure;
  if (!measure.zeros_unmeasured) return measured;
  std::erase_if(measured.values, [&](const Value& one) {
    const std::vector<double> of = measure.Of(one.interface);
    return std::all_of(of.begin(), of.end(), [](double value) { return value == 0; });
  });
  return measured;
}

std::vector<std::string> InOrder(const plan::Protocol& protocol) {
  std::vector<std::string> names = {protocol.control};
  for (const std::string& interface : protocol.interfaces) {
    if (interface != protocol.control) names.push_back(interface);
  }
  return names;
}

statistics::StudyTable TableOf(const Measure& measure, const plan::Protocol& protocol) {
  statistics::StudyTable table;
  std::vector<std::string> kept;
  for (const std::string& name : InOrder(protocol)) {
    std::vector<double> values = measure.Of(name);
    if (values.empty()) continue;
    kept.push_back(name);
    std::vector<double>& exposures = table.exposures.emplace_back();
    for (const Value& one : measure.values) {
      if (one.interface == name) exposures.push_back(measure.counts ? one.exposure_min : 1);
    }
    table.groups.push_back({name, std::move(values)});
  }
  std::map<std::string, std::map<std::string, double>> by_person;
  for (const Value& one : measure.values) by_person[one.participant][one.interface] = one.value;
  statistics::Blocks blocks;
  blocks.groups = kept;
  for (const auto& [participant, values] : by_person) {
    if (values.size() != kept.size()) continue;
    blocks.subjects.push_back(participant);
    std::vector<double>& row = blocks.values.emplace_back();
    for (const std::string& name : kept) row.push_back(values.at(name));
  }
  if (blocks.subjects.size() > 1) {
    table.blocks = std::move(blocks);
  } else if (by_person.size() < measure.values.size()) {
    table.unpaired = "fewer than two participants have a value for every interface";
  }
  return table;
}

statistics::StudyTable RateTableOf(const Measure& counts, const plan::Protocol& protocol) {
  Measure rates = counts;
  for (Value& one : rates.values) one.value /= one.exposure_min;
  statistics::StudyTable table = TableOf(counts, protocol);
  table.blocks = TableOf(rates, protocol).blocks;
  return table;
}

}  // namespace footing::study::report
