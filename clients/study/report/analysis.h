#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/study/report/measures.h"

namespace footing::study::report {

struct Analysis {
  /// {name, control, participants, withdrawn, unfinished, synthetic, measures: [{id, title, groups,
  /// test, paired}]}; `test` and `paired` are reports of footing-eval stats, or {error}.
  nlohmann::ordered_json json;
  std::vector<Measure> measures;
  bool synthetic = false;  ///< Any part of it does not come from a person.
};

/// Every measure of a study with its tests against the control. The protocol's seed is that of
/// random relabelling, too.
Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people);

/// A row for every value that a figure shows: measure,participant,interface,value.
std::string ValuesCsv(const Analysis& analysis);

}  // namespace footing::study::report
