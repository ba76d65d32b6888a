#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/statistics/analysis.h"
#include "common/statistics/effect_sizes.h"

/// The parts of Analyze: what each test reports.
namespace footing::statistics {

using nlohmann::ordered_json;

/// The rows of a report, what stands beside them, and what its note depends on.
struct Findings {
  std::string method;     ///< As `--method` names it, or "quadrature".
  std::string procedure;  ///< What was computed, in words.
  ordered_json rows = ordered_json::array();
  ordered_json extra = ordered_json::object();  ///< Fields beside the rows.
  /// Remarks on the data for the note: clauses without a full stop.
  std::vector<std::string> remarks;
};

Result<Findings> ReportDunnett(const StudyTable& table, const AnalysisRequest& request);
Result<Findings> ReportSteel(const StudyTable& table, const AnalysisRequest& request);
Result<Findings> ReportPaired(const StudyTable& table, const AnalysisRequest& request);
Result<Findings> ReportRate(const StudyTable& table, const AnalysisRequest& request);

/// A row with its names and sizes: of treatment `i` >= 1.
ordered_json NewRow(const Groups& groups, std::size_t i);
/// A number, or null if it is infinite or not a number.
ordered_json Number(double value);
/// Sets low and high.
void AddInterval(const Interval& interval, ordered_json& row);
/// Adds what a relabelling says of the p of a row: the smallest possible one, or the error of a
/// random one.
void AddRelabelled(const RelabelledRow& relabelled, Method method, ordered_json& row);
/// Adds the number of relabellings, and the seed of random ones.
void AddRelabellings(const Relabelled& relabelled, const AnalysisRequest& request,
                     ordered_json& extra);
/// {estimate, low, high}.
ordered_json ToJson(const EffectSize& effect);
/// The critical value of simultaneous intervals of rank statistics.
double CriticalZ(const std::vector<double>& loadings, const AnalysisRequest& request);
/// The effect with only the end that the alternative bounds; an open end is that of `widest`.
EffectSize DirectedEffect(EffectSize effect, Alternative alternative, const Interval& widest);
/// Adds paired_p, the within-subject permutation p, to rows of independent groups.
void AddPairedP(const StudyTable& table, const AnalysisRequest& request, ordered_json& rows);
/// As the request asks; for its asymptotic method, exact where that is possible.
Relabelling RelabellingOf(const AnalysisRequest& request);
/// A remark where a p of relabelling can never be below the level; nothing otherwise.
void RemarkOnSmallestP(const std::vector<RelabelledRow>& rows, const AnalysisRequest& request,
                       std::vector<std::string>& remarks);
/// Three significant digits, for sentences.
std::string Short(double value);

}  // namespace footing::statistics
