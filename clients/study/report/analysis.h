#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "clients/study/report/latency.h"
#include "clients/study/report/measures.h"
#include "common/statistics/analysis.h"

namespace footing::study::report {

/// How the measures are tested, as footing-eval stats has it.
struct TestOptions {
  statistics::Alternative alternative = statistics::Alternative::kTwoSided;
  statistics::Ties ties = statistics::Ties::kPairwise;  ///< Of Steel's test.
  std::optional<statistics::Method> method;             ///< Of Steel's p; without: see there.
  std::optional<std::uint64_t> seed;  ///< Of random permutations; without: the protocol's.
};

struct Analysis {
  /// {name, control, participants, withdrawn, unfinished, synthetic, simulated_time, tests:
  /// {alternative, ties, method, seed}, measures: [{id, title, groups: [{interface, n, mean,
  /// median, least, greatest, censored}], note, participants, test, paired_participants, paired,
  /// rate}], latency: [{interface, stage, n, p50_ms, p95_ms}]}; `test`, `paired` and `rate` (of all
  /// failures together) are reports of footing-eval stats, or {error}; `censored` is of times to
  /// failure; `note` is there where the values need one.
  nlohmann::ordered_json json;
  std::vector<Measure> measures;
  std::vector<StageLatency> latency;
  bool synthetic = false;       ///< Any part of it does not come from a person.
  bool simulated_time = false;  ///< Of any session.
};

/// Every measure of a study with its tests against the control.
Analysis Analyze(const plan::Protocol& protocol, const std::vector<records::Records>& people,
                 const TestOptions& options = {});

/// A row for everything that a figure shows: measure,plotted,participant,interface,value. `plotted`
/// is point, lower_quartile, median, upper_quartile, bar or label.
std::string ValuesCsv(const Analysis& analysis);

}  // namespace footing::study::report
