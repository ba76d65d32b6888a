#include "common/statistics/analysis.h"

#include <cmath>

#include "common/statistics/moments.h"
#include "common/statistics/quantile.h"
#include "common/statistics/report_rows.h"

namespace footing::statistics {
namespace {

ordered_json Summary(const Group& group, std::size_t index) {
  const std::vector<double>& values = group.values;
  const std::size_t n = values.size();
  const double mean = Mean(values);
  std::vector<double> residuals;
  for (const double value : values) residuals.push_back(value - mean);
  ordered_json summary = {{"group_index", index}, {"group", group.name}, {"n", n}};
  summary["mean"] = mean;
  summary["standard_deviation"] =
      n > 1 ? ordered_json(Norm(residuals) / std::sqrt(static_cast<double>(n - 1))) : nullptr;
  summary["median"] = MedianOf(values);
  return summary;
}

/// What to believe of a test for groups that it takes as independent.
std::string AdviceOnDesign(const StudyTable& table, const std::string& test) {
  const std::string assumption = test + " treats the groups as independent";
  if (table.blocks && table.blocks->subjects.size() > 1) {
    return "Believe the paired p: each of the " + std::to_string(table.blocks->subjects.size()) +
           " subjects has a value in every group, and " + assumption +
           ", which counts the differences between subjects as noise";
  }
  if (!table.unpaired.empty()) {
    return "Do not believe p: " + assumption +
           ", but some subjects have several values, and they could not be paired (" +
           table.unpaired + ")";
  }
  return "Believe p only if every group has other subjects: " + assumption +
         ", so for a study in which each subject used every interface believe the paired test, "
         "which needs to know the subject of each value";
}

std::string Advice(const StudyTable& table, const AnalysisRequest& request,
                   const Findings& findings) {
  switch (request.test) {
    case TestKind::kDunnett:
      return AdviceOnDesign(table, "Dunnett's test") +
             "; it also takes the values as normal with one variance";
    case TestKind::kSteel:
      return AdviceOnDesign(table, "Steel's test");
    case TestKind::kPaired:
      if (request.method == Method::kAsymptotic) {
        return "Believe permutation_p rather than p: p is Dunnett's test with the subject as a "
               "block, which takes the values as normal with one variance";
      }
      return "Believe p: every subject used every group, and permuting the labels within each "
             "subject needs neither normal values nor equal variances, while block_dunnett_p "
             "needs both, wilcoxon_holm uses ranks only, and friedman_p answers only whether any "
             "group differs";
    case TestKind::kRate:
      return AdviceOnDesign(table, "the rate model") + "; p is of the " +
             findings.extra.at("model").get<std::string>() +
             " model; the paper compares counts with Steel's test instead (footnote 1), because "
             "failures are independent events that add up until the goal is reached, so a count "
             "measures how difficult the task is";
  }
  return "";
}

Result<Findings> RunTest(const StudyTable& table, const AnalysisRequest& request) {
  switch (request.test) {
    case TestKind::kDunnett:
      return ReportDunnett(table, request);
    case TestKind::kSteel:
      return ReportSteel(table, request);
    case TestKind::kPaired:
      return ReportPaired(table, request);
    case TestKind::kRate:
      return ReportRate(table, request);
  }
  return Failure("unknown test");
}

}  // namespace

TableUse UseOf(TestKind test) {
  if (test == TestKind::kPaired) return TableUse::kPaired;
  return test == TestKind::kRate ? TableUse::kCounts : TableUse::kIndependent;
}

Result<ordered_json> Analyze(const StudyTable& table, const AnalysisRequest& request) {
  auto findings = RunTest(table, request);
  if (!findings) return findings.error();
  std::string note = Advice(table, request, *findings);
  for (const std::string& remark : findings->remarks) note += "; " + remark;
  ordered_json report = {
      {"test", NameOf(request.test)},     {"alternative", NameOf(request.alternative)},
      {"method", findings->method},       {"procedure", findings->procedure},
      {"confidence", request.confidence}, {"control", table.groups.front().name}};
  report.update(findings->extra);
  report["groups"] = ordered_json::array();
  for (std::size_t i = 0; i < table.groups.size(); ++i) {
    report["groups"].push_back(Summary(table.groups[i], i));
  }
  report["rows"] = std::move(findings->rows);
  report["note"] = note + ".";
  report["remarks"] = findings->remarks;
  return report;
}

std::string_view NameOf(TestKind test) {
  switch (test) {
    case TestKind::kDunnett:
      return "dunnett";
    case TestKind::kSteel:
      return "steel";
    case TestKind::kPaired:
      return "paired";
    case TestKind::kRate:
      return "rate";
  }
  return "";
}

std::string_view NameOf(Alternative alternative) {
  switch (alternative) {
    case Alternative::kTwoSided:
      return "two.sided";
    case Alternative::kGreater:
      return "greater";
    case Alternative::kLess:
      return "less";
  }
  return "";
}

std::string_view NameOf(Method method) {
  switch (method) {
    case Method::kExact:
      return "exact";
    case Method::kPermutation:
      return "permutation";
    case Method::kAsymptotic:
      return "asymptotic";
  }
  return "";
}

std::string_view NameOf(Ties ties) { return ties == Ties::kPairwise ? "pairwise" : "joint"; }

}  // namespace footing::statistics
