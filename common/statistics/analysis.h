#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/base/result.h"
#include "common/statistics/samples.h"
#include "common/statistics/study_table.h"
#include "common/statistics/within_subject.h"

namespace footing::statistics {

enum class TestKind { kDunnett, kSteel, kPaired, kRate };

/// Test to run and its settings.
struct AnalysisRequest {
  TestKind test = TestKind::kSteel;
  Alternative alternative = Alternative::kTwoSided;
  Ties ties = Ties::kPairwise;   ///< Steel only.
  std::optional<Method> method;  ///< Without: the one that the test prefers.
  std::uint64_t seed = 1;
  std::size_t permutations = 100'000;
  double confidence = 0.95;  ///< In (0.5, 1), of all comparisons of a table together.
};

/// How the table of a test is to be read.
TableUse UseOf(TestKind test);

/// The names of command lines and of reports: "steel", "two.sided", "exact".
std::string_view NameOf(TestKind test);
std::string_view NameOf(Alternative alternative);
std::string_view NameOf(Method method);
std::string_view NameOf(Ties ties);

/// Names for a command line; the first is the default.
inline constexpr std::array kTests{TestKind::kDunnett, TestKind::kSteel, TestKind::kPaired,
                                   TestKind::kRate};
inline constexpr std::array kAlternatives{Alternative::kTwoSided, Alternative::kGreater,
                                          Alternative::kLess};
inline constexpr std::array kAllTies{Ties::kPairwise, Ties::kJoint};
inline constexpr std::array kMethods{Method::kExact, Method::kPermutation, Method::kAsymptotic};

/// Names of all values of an enum.
template <typename Enum, std::size_t count>
std::vector<std::string> NamesOf(const std::array<Enum, count>& all) {
  std::vector<std::string> names;
  for (const Enum value : all) names.emplace_back(NameOf(value));
  return names;
}
/// The one of that name; the first one where none has it.
template <typename Enum, std::size_t count>
Enum Named(std::string_view name, const std::array<Enum, count>& all) {
  for (const Enum value : all) {
    if (NameOf(value) == name) return value;
  }
  return all.front();
}

/// The report of a test, a table of one row per treatment with a note on which p to believe;
/// docs/statistics.md lists its fields. UsageError for a method that the test does not have.
Result<nlohmann::ordered_json> Analyze(const StudyTable& table, const AnalysisRequest& request);

/// The parts of Analyze: what each test reports.
using nlohmann::ordered_json;

/// The rows of a report, what stands beside them, and what its note depends on.
struct Findings {
  std::string method;     ///< As `--method` names it, or "quadrature".
  std::string procedure;  ///< Description of the computation.
  ordered_json rows = ordered_json::array();
  ordered_json extra = ordered_json::object();  ///< Fields beside the rows.
  /// Remarks on the data for the note: clauses without a full stop.
  std::vector<std::string> remarks;
};

/// Each runs one test on a table and reports its rows.
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

/// The distribution of the greatest of several statistics that share a control.
///
///   | symbol | name here | meaning                                                   |
///   | k      |           | number of treatments                                      |
///   | l_i    | loadings  | correlation of T_i and T_j is l_i l_j; each l_i in (0, 1) |
///   | nu     | degrees   | degrees of freedom of the common s; infinite: s = 1       |
///
/// T_i = Z_i / s with Z_i = l_i Y + sqrt(1 - l_i^2) E_i, where Y and the E_i are independent
/// standard normal and s^2 is a chi-square variable over nu. Given s and Y the T_i are
/// independent, so the integral over k dimensions becomes one over two, for any k.
struct ManyToOne {
  std::vector<double> loadings;
  double degrees = std::numeric_limits<double>::infinity();
  bool two_sided = true;
};

/// P(max |T_i| >= t) if two-sided, otherwise P(max T_i >= t). The absolute error is below 1e-13;
/// small tails keep 10 digits. `t` may be infinite.
double MaxTail(const ManyToOne& family, double t);

/// The t with MaxTail(family, t) = `tail`, which is in (0, 0.5).
double MaxQuantile(const ManyToOne& family, double tail);

// Quantiles of what a study reports: linear between the two nearest values, as in R (type 7) and
// NumPy, so that a median is the mean of the two values in the middle. Those of common/base are
// values that occurred.

/// `share` is in [0, 1]. There must be one value.
inline double QuantileOf(std::vector<double> values, double share) {
  FOOTING_CHECK(!values.empty() && share >= 0 && share <= 1);
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

/// Median of the values.
inline double MedianOf(std::vector<double> values) { return QuantileOf(std::move(values), 0.5); }

}  // namespace footing::statistics
