#include "common/statistics/analysis.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/base/result.h"
#include "common/base/text.h"
#include "common/statistics/dunnett.h"
#include "common/statistics/within_subject.h"

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

/// Advice on the result of a test for groups that it takes as independent.
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

namespace {

/// All integrands are analytic and vanish at both ends, where the trapezoidal rule converges
/// faster than Gauss rules: for a Gaussian of width w and the step h the error is
/// exp(-2 (pi w / h)^2). The steps leave a margin for products of many factors.
constexpr double kStepY = 0.4;  // In units of the sharpest conditional deviation.
constexpr double kStepLogS = 0.1;
constexpr double kReachY = 9;           // P(|Y| > 9) = 2e-19.
constexpr double kNegligible = 1e-18;   // Share of a sum so far.
constexpr double kBeyondDoubles = 39;   // The normal tail is below the smallest double.
constexpr double kLogNegligible = -46;  // exp(-46) = 1e-20.

/// MaxTail with s = 1.
class NormalMaximum {
 public:
  explicit NormalMaximum(const ManyToOne& family) : two_sided_(family.two_sided) {
    std::map<double, int> counts;
    for (const double loading : family.loadings) ++counts[loading];
    step_ = kStepY;
    for (const auto& [loading, count] : counts) {
      const double deviation = std::sqrt((1 - loading) * (1 + loading));
      FOOTING_CHECK(loading > 0 && deviation > 0);
      factors_.push_back({loading, deviation, static_cast<double>(count)});
      step_ = std::min(step_, kStepY * deviation);
    }
    greatest_loading_ = counts.rbegin()->first;
  }

  double Tail(double x) const {
    if (x > kBeyondDoubles) return 0;
    if (two_sided_ && x <= 0) return 1;
    if (x < -kBeyondDoubles) return 1;
    // Far out all weight is near y = l x.
    const double high = kReachY + greatest_loading_ * std::max(0.0, x);
    const int last = static_cast<int>(high / step_) + 1;
    // Two-sided, the integrand is even in y.
    const int first = two_sided_ ? 0 : -static_cast<int>(kReachY / step_) - 1;
    double sum = 0;
    for (int i = first; i <= last; ++i) {
      const double y = i * step_;
      const double share = two_sided_ && i > 0 ? 2 : 1;
      sum += share * std::exp(-y * y / 2) * Any(y, x);
    }
    return std::min(1.0, sum * step_ / std::sqrt(2 * std::numbers::pi));
  }

 private:
  struct Factor {
    double loading, deviation, count;
  };

  /// P(any Z_i >= x | Y = y), as 1 - product(1 - q_i) without cancellation.
  double Any(double y, double x) const {
    double log_none = 0;
    for (const Factor& factor : factors_) {
      double q = NormalTail((x - factor.loading * y) / factor.deviation);
      if (two_sided_) q += NormalTail((x + factor.loading * y) / factor.deviation);
      log_none += factor.count * std::log1p(-std::min(1.0, q));
    }
    return -std::expm1(log_none);
  }

  std::vector<Factor> factors_;
  double greatest_loading_ = 0;
  double step_ = 0;
  bool two_sided_;
};

}  // namespace

double MaxTail(const ManyToOne& family, double t) {
  FOOTING_CHECK(!family.loadings.empty() && family.degrees > 0 && !std::isnan(t));
  const NormalMaximum maximum(family);
  const double nu = family.degrees;
  if (std::isinf(nu)) return maximum.Tail(t);
  if (t == 0) return maximum.Tail(0);
  // With u = log s the density of s is proportional to exp(nu (u - e^(2u) / 2)); its constant
  // comes out of the same sum.
  const double step = std::min(kStepLogS, 0.4 / std::sqrt(2 * nu));
  const auto log_density = [nu](double u) { return nu * (u - std::expm1(2 * u) / 2); };
  int i = 1;
  while (log_density(i * step) > kLogNegligible) ++i;
  double norm = 0, sum = 0;
  for (;; --i) {
    const double u = i * step;
    const double density = std::exp(log_density(u));
    norm += density;
    sum += density * maximum.Tail(t * std::exp(u));
    if (u < 0 && density <= kNegligible * std::min(norm, sum)) break;
  }
  return std::min(1.0, sum / norm);
}

double MaxQuantile(const ManyToOne& family, double tail) {
  FOOTING_CHECK(tail > 0 && tail < 0.5);
  // Nearly a straight line where tails are heavy.
  const auto excess = [&](double log_t) {
    return std::log(MaxTail(family, std::exp(log_t)) / tail);
  };
  double low = 0, high = 1;
  while (excess(low) < 0) low -= 2;
  while (excess(high) > 0) high += 1;
  return std::exp(FindRoot(excess, low, high));
}

}  // namespace footing::statistics
