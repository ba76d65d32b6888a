#include "common/statistics/report_rows.h"

#include <algorithm>
#include <cmath>

#include "common/statistics/dunnett.h"
#include "common/statistics/many_to_one.h"
#include "common/statistics/within_subject.h"
#include "common/base/number.h"

namespace footing::statistics {
namespace {

std::vector<double> Loadings(const Groups& groups) {
  std::vector<double> loadings;
  const double n_0 = static_cast<double>(groups[0].values.size());
  for (std::size_t i = 1; i < groups.size(); ++i) {
    const double n_i = static_cast<double>(groups[i].values.size());
    loadings.push_back(std::sqrt(n_i / (n_i + n_0)));
  }
  return loadings;
}

EffectSize ShiftOf(const Groups& groups, std::size_t i, double z, Alternative alternative) {
  return DirectedEffect(HodgesLehmann(groups[0].values, groups[i].values, z), alternative, {});
}

EffectSize DeltaOf(const Groups& groups, std::size_t i, double z, Alternative alternative) {
  return DirectedEffect(CliffsDelta(groups[0].values, groups[i].values, z), alternative, {-1, 1});
}

/// For a method other than the exact one: what the exact p could be at least, if that is cheap.
void RemarkOnSmallSteel(const StudyTable& table, const AnalysisRequest& request,
                        std::vector<std::string>& remarks) {
  Relabelling relabelling;
  relabelling.method = Method::kExact;
  relabelling.most_tables = 200'000;
  const auto exact = SteelRelabelling(table.groups, request.alternative, request.ties, relabelling);
  if (exact) RemarkOnSmallestP(exact->rows, request, remarks);
}

void AddAsymptoticSteel(const StudyTable& table, const AnalysisRequest& request,
                        Findings& findings) {
  const auto p_with = [&](const SteelLimit& limit) {
    return SteelAsymptotic(table.groups, request.alternative, limit);
  };
  findings.method = NameOf(Method::kAsymptotic);
  findings.procedure += "; p by the normal limit of all statistics together";
  const bool joint = request.ties == Ties::kJoint;
  const std::vector<double> p = p_with({request.ties, false, false});
  const std::vector<double> other = p_with({request.ties, !joint, joint});
  for (std::size_t i = 0; i < p.size(); ++i) {
    findings.rows[i]["p"] = p[i];
    findings.rows[i][joint ? "p_continuity" : "p_finite_sample"] = other[i];
  }
  findings.remarks.push_back(
      "the asymptotic p can be off by a factor of two in small or heavily tied groups, so prefer "
      "--method exact or permutation");
  RemarkOnSmallSteel(table, request, findings.remarks);
}

Result<void> AddRelabelledSteel(const StudyTable& table, const AnalysisRequest& request,
                                Findings& findings) {
  const auto relabelled =
      SteelRelabelling(table.groups, request.alternative, request.ties, RelabellingOf(request));
  if (!relabelled) return relabelled.error();
  findings.method = NameOf(relabelled->method);
  findings.procedure += relabelled->method == Method::kExact
                            ? "; p over all ways to deal the values to the groups"
                            : "; p over random ways to deal the values to the groups";
  for (std::size_t i = 0; i < relabelled->rows.size(); ++i) {
    findings.rows[i]["p"] = relabelled->rows[i].p;
    AddRelabelled(relabelled->rows[i], relabelled->method, findings.rows[i]);
  }
  AddRelabellings(*relabelled, request, findings.extra);
  if (relabelled->method == Method::kExact) {
    RemarkOnSmallestP(relabelled->rows, request, findings.remarks);
  } else if (request.method == Method::kPermutation) {  // Else the exact p was too dear already.
    RemarkOnSmallSteel(table, request, findings.remarks);
  }
  return {};
}

}  // namespace

Result<Findings> ReportDunnett(const StudyTable& table, const AnalysisRequest& request) {
  if (request.method) {
    return UsageError("--method does not apply to --test dunnett, whose p is a numerical integral");
  }
  const auto test = DunnettTest(table.groups, request.alternative, request.confidence);
  if (!test) return test.error();
  Findings findings;
  findings.method = "quadrature";
  findings.procedure =
      "Dunnett's test of every group against the control, single step, by numerical integration";
  findings.extra["critical_value"] = test->critical;
  const double z = CriticalZ(Loadings(table.groups), request);
  for (std::size_t i = 1; i < table.groups.size(); ++i) {
    const DunnettRow& compared = test->rows[i - 1];
    ordered_json row = NewRow(table.groups, i);
    row["estimate"] = compared.estimate;
    row["statistic"] = compared.t;
    row["df"] = test->degrees;
    row["p"] = compared.p;
    row["standard_error"] = compared.standard_error;
    AddInterval(compared.interval, row);
    row["hodges_lehmann"] = ToJson(ShiftOf(table.groups, i, z, request.alternative));
    row["cliffs_delta"] = ToJson(DeltaOf(table.groups, i, z, request.alternative));
    findings.rows.push_back(std::move(row));
  }
  AddPairedP(table, request, findings.rows);
  if (test->no_variance) {
    findings.remarks.push_back(
        "no value differs from its group's mean, so t has no error to be compared with and p says "
        "nothing");
  } else if (test->degrees < 10) {
    findings.remarks.push_back("with " + Short(test->degrees) +
                               " degrees of freedom p leans on the normal distribution, which so "
                               "few values cannot show; compare --test steel");
  }
  return findings;
}

Result<Findings> ReportSteel(const StudyTable& table, const AnalysisRequest& request) {
  Findings findings;
  findings.procedure = "Steel's rank test of every group against the control, ties ";
  findings.procedure += NameOf(request.ties);
  findings.extra["ties"] = NameOf(request.ties);
  const double z = CriticalZ(Loadings(table.groups), request);
  const auto scores = SteelScores(table.groups, request.ties);
  bool constant = false;
  for (std::size_t i = 1; i < table.groups.size(); ++i) {
    const RankScore& score = scores[i - 1];
    constant = constant || score.deviation == 0;
    const EffectSize shift = ShiftOf(table.groups, i, z, request.alternative);
    ordered_json row = NewRow(table.groups, i);
    row["estimate"] = shift.estimate;
    row["statistic"] = score.z;
    row["df"] = nullptr;
    row["p"] = 1;
    row["u"] = score.u;
    AddInterval(shift.interval, row);
    row["cliffs_delta"] = ToJson(DeltaOf(table.groups, i, z, request.alternative));
    findings.rows.push_back(std::move(row));
  }
  if (request.method == Method::kAsymptotic) {
    AddAsymptoticSteel(table, request, findings);
  } else if (const auto added = AddRelabelledSteel(table, request, findings); !added) {
    return added.error();
  }
  AddPairedP(table, request, findings.rows);
  if (constant) {
    findings.remarks.push_back(
        "where all values compared are equal there is nothing to rank, and p is 1");
  }
  return findings;
}

ordered_json NewRow(const Groups& groups, std::size_t i) {
  return {{"comparison", groups[i].name + " - " + groups[0].name},
          {"group_index", i},
          {"group", groups[i].name},
          {"n", groups[i].values.size()},
          {"n_control", groups[0].values.size()}};
}

ordered_json Number(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json ToJson(const EffectSize& effect) {
  return {{"estimate", Number(effect.estimate)},
          {"low", Number(effect.interval.low)},
          {"high", Number(effect.interval.high)}};
}

void AddInterval(const Interval& interval, ordered_json& row) {
  row["low"] = Number(interval.low);
  row["high"] = Number(interval.high);
}

void AddRelabelled(const RelabelledRow& relabelled, Method method, ordered_json& row) {
  if (method == Method::kExact) row["smallest_p"] = relabelled.smallest_p;
  if (method == Method::kPermutation) row["p_standard_error"] = relabelled.standard_error;
}

void AddRelabellings(const Relabelled& relabelled, const AnalysisRequest& request,
                     ordered_json& extra) {
  extra["relabellings"] = static_cast<std::uint64_t>(relabelled.relabellings);
  if (relabelled.method == Method::kPermutation) extra["seed"] = request.seed;
}

double CriticalZ(const std::vector<double>& loadings, const AnalysisRequest& request) {
  return MaxQuantile(
      {.loadings = loadings, .two_sided = request.alternative == Alternative::kTwoSided},
      1 - request.confidence);
}

EffectSize DirectedEffect(EffectSize effect, Alternative alternative, const Interval& widest) {
  effect.interval = Directed(effect.interval, alternative, widest);
  return effect;
}

void AddPairedP(const StudyTable& table, const AnalysisRequest& request, ordered_json& rows) {
  if (!table.blocks) return;
  Relabelling relabelling = RelabellingOf(request);
  relabelling.method.reset();
  const auto paired = PermuteWithinSubjects(*table.blocks, request.alternative, relabelling);
  if (!paired) return;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i]["paired_p"] = paired->relabelled.rows[i].p;
  }
}

Relabelling RelabellingOf(const AnalysisRequest& request) {
  Relabelling relabelling;
  if (request.method != Method::kAsymptotic) relabelling.method = request.method;
  relabelling.seed = request.seed;
  relabelling.permutations = request.permutations;
  return relabelling;
}

void RemarkOnSmallestP(const std::vector<RelabelledRow>& rows, const AnalysisRequest& request,
                       std::vector<std::string>& remarks) {
  const double level = 1 - request.confidence;
  constexpr double kRounding = 1e-12;  // p = 0.05 is not below 0.05.
  double least = 1, greatest = 0;
  std::size_t unreachable = 0;
  for (const RelabelledRow& row : rows) {
    if (row.smallest_p < level - kRounding) continue;
    ++unreachable;
    least = std::min(least, row.smallest_p);
    greatest = std::max(greatest, row.smallest_p);
  }
  if (unreachable == 0) return;
  const std::string which = unreachable == rows.size()
                                ? "the exact p of any comparison"
                                : "the exact p of " + std::to_string(unreachable) + " of " +
                                      std::to_string(rows.size()) + " comparisons";
  const std::string range =
      least == greatest ? Short(least) : Short(least) + " to " + Short(greatest);
  remarks.push_back("with so few values " + which + " can never be below " + Short(level) +
                    " whatever the effect (smallest possible: " + range + ")");
}

std::string Short(double value) {
  if (value == 0) return "0";
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  std::string text = text::Fixed(value, std::clamp(2 - magnitude, 0, 12));
  if (text.find('.') == std::string::npos) return text;
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

}  // namespace footing::statistics
