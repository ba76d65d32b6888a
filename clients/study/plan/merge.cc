#include <algorithm>

#include "clients/study/plan/ranges.h"
#include "common/statistics/quantile.h"

namespace footing::study::ranges {
namespace {

using nlohmann::json;

using statistics::MedianOf;

Measured Read(const json& measured) {
  Measured one;
  one.played.interface = measured.at("interface").get<std::string>();
  one.played.turn_by = measured.value("turn_by", one.played.turn_by);
  one.provenance.participants = measured.at("participants").get<std::vector<std::string>>();
  one.provenance.when = measured.value("when", "");
  one.provenance.how = measured.value("how", "");
  one.provenance.by = measured.value("by", "");
  one.provenance.simulated = measured.value("simulated", false);
  for (const auto& [name, range] : measured.at("ranges").items()) {
    one.ranges[name] = {range.at("low").get<double>(), range.at("high").get<double>(),
                        range.value("seconds", 0.0)};
  }
  return one;
}

}  // namespace

Result<Measured> MeasuredOf(const std::string& table, const std::string& file) {
  const json root = json::parse(table, nullptr, false, true);
  if (!root.is_object() || !root.contains("measured")) {
    return InvalidData(file + " has no measured ranges; footing-study ranges measures them");
  }
  try {
    return Read(root["measured"]);
  } catch (const json::exception& error) {
    return InvalidData(file + ": measured: " + error.what());
  }
}

Result<Measured> Merge(const std::vector<Measured>& people) {
  if (people.size() < 2) return UsageError("a group needs the tables of two people or more");
  Measured group;
  group.played = people.front().played;
  for (const Measured& one : people) {
    if (one.played.interface != group.played.interface ||
        one.played.turn_by != group.played.turn_by) {
      return UsageError("the tables are of different interfaces: " + group.played.interface +
                        " and " + one.played.interface +
                        "; a group's are of one, with the same turn_by");
    }
    auto& participants = group.provenance.participants;
    for (const std::string& code : one.provenance.participants) {
      if (std::find(participants.begin(), participants.end(), code) != participants.end()) {
        return UsageError("participant " + code + " comes twice in the group");
      }
      participants.push_back(code);
    }
    group.provenance.simulated = group.provenance.simulated || one.provenance.simulated;
  }
  for (const auto& [name, range] : people.front().ranges) {
    std::vector<double> low, high;
    for (const Measured& one : people) {
      const auto found = one.ranges.find(name);
      if (found == one.ranges.end()) continue;
      low.push_back(found->second.low);
      high.push_back(found->second.high);
    }
    group.ranges[name] = {MedianOf(low), MedianOf(high), 0};
  }
  return group;
}

}  // namespace footing::study::ranges
