#include "common/statistics/dunnett.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "common/statistics/analysis.h"
#include "common/statistics/rate.h"
#include "common/statistics/within_subject.h"

namespace footing::statistics {
namespace {

/// Quantities to which both designs come down.
struct Fit {
  std::vector<double> means;  ///< The control's first.
  std::vector<double> sizes;
  double deviation = 0;  ///< Pooled, with `degrees` degrees of freedom.
  double degrees = 0;
};

double Ratio(double estimate, double standard_error) {
  if (estimate == 0) return 0;
  constexpr double kGreatest = std::numeric_limits<double>::max();
  const double ratio = estimate / standard_error;
  return std::clamp(ratio, -kGreatest, kGreatest);
}

Dunnett Compare(const Fit& fit, Alternative alternative, double confidence) {
  Dunnett test;
  test.degrees = fit.degrees;
  test.no_variance = fit.deviation == 0;
  ManyToOne family;
  family.degrees = fit.degrees;
  family.two_sided = alternative == Alternative::kTwoSided;
  for (std::size_t i = 1; i < fit.sizes.size(); ++i) {
    family.loadings.push_back(std::sqrt(fit.sizes[i] / (fit.sizes[i] + fit.sizes[0])));
  }
  test.critical = MaxQuantile(family, 1 - confidence);
  for (std::size_t i = 1; i < fit.means.size(); ++i) {
    DunnettRow& row = test.rows.emplace_back();
    row.estimate = fit.means[i] - fit.means[0];
    row.standard_error = fit.deviation * std::sqrt(1 / fit.sizes[i] + 1 / fit.sizes[0]);
    row.t = Ratio(row.estimate, row.standard_error);
    const bool nothing_differs = row.estimate == 0 && test.no_variance;
    row.p = nothing_differs ? 1 : MaxTail(family, Evidence(row.t, alternative));
    const double reach = test.critical * row.standard_error;
    row.interval = Directed({row.estimate - reach, row.estimate + reach}, alternative);
  }
  return test;
}

}  // namespace

Result<Dunnett> DunnettTest(const Groups& groups, Alternative alternative, double confidence) {
  Fit fit;
  std::vector<double> residuals;
  for (const Group& group : groups) {
    FOOTING_CHECK(!group.values.empty());
    const double mean = Mean(group.values);
    for (const double value : group.values) residuals.push_back(value - mean);  // 0 if all equal.
    fit.means.push_back(mean);
    fit.sizes.push_back(static_cast<double>(group.values.size()));
  }
  FOOTING_CHECK(groups.size() > 1);
  fit.degrees = static_cast<double>(residuals.size()) - static_cast<double>(groups.size());
  if (fit.degrees < 1) {
    return InvalidData(
        "Dunnett's test needs a group with two values, for it compares with the "
        "variance within groups");
  }
  fit.deviation = Norm(residuals) / std::sqrt(fit.degrees);
  return Compare(fit, alternative, confidence);
}

Result<Dunnett> BlockDunnettTest(const Blocks& blocks, Alternative alternative, double confidence) {
  const std::size_t subjects = blocks.values.size();
  const std::size_t groups = blocks.groups.size();
  FOOTING_CHECK(groups > 1);
  if (subjects < 2) return InvalidData("a within-subject test needs two subjects or more");
  // Differences from each subject's value in the control: what is added to all values of a
  // subject is gone, exactly where the values are.
  std::vector<std::vector<double>> differences = blocks.values;
  for (std::vector<double>& row : differences) {
    const double control = row.front();
    for (double& value : row) value -= control;
  }
  Fit fit;
  std::vector<double> column(subjects);
  for (std::size_t group = 0; group < groups; ++group) {
    for (std::size_t i = 0; i < subjects; ++i) column[i] = differences[i][group];
    const double mean = Mean(column);
    for (std::size_t i = 0; i < subjects; ++i) differences[i][group] -= mean;
    fit.means.push_back(mean);
    fit.sizes.push_back(static_cast<double>(subjects));
  }
  std::vector<double> residuals;
  for (const std::vector<double>& row : differences) {
    const double mean = Mean(row);
    for (const double value : row) residuals.push_back(value - mean);
  }
  fit.degrees = static_cast<double>((subjects - 1) * (groups - 1));
  fit.deviation = Norm(residuals) / std::sqrt(fit.degrees);
  return Compare(fit, alternative, confidence);
}

namespace {

/// Wilcoxon's test of every treatment, with Holm's adjustment.
void AddWilcoxon(const Blocks& blocks, const AnalysisRequest& request, Findings& findings) {
  std::vector<double> p, exact_p;
  for (std::size_t i = 1; i < blocks.groups.size(); ++i) {
    const SignedRanks test = WilcoxonTest(Differences(blocks, i), request.alternative);
    ordered_json& row = findings.rows[i - 1];
    row["wilcoxon_v"] = test.v;
    row["wilcoxon_p"] = test.p;
    row["wilcoxon_exact_p"] = test.exact_p;
    p.push_back(test.p);
    exact_p.push_back(test.exact_p);
  }
  const std::vector<double> holm = Holm(p), exact_holm = Holm(exact_p);
  for (std::size_t i = 0; i < p.size(); ++i) {
    findings.rows[i]["wilcoxon_holm"] = holm[i];
    findings.rows[i]["wilcoxon_exact_holm"] = exact_holm[i];
  }
  // All differences of one sign, in the comparison that Holm weighs most.
  const double sides = request.alternative == Alternative::kTwoSided ? 2 : 1;
  const double smallest = static_cast<double>(p.size()) * sides *
                          std::pow(0.5, static_cast<double>(blocks.subjects.size()));
  if (smallest >= 1 - request.confidence) {
    findings.remarks.push_back("with " + std::to_string(blocks.subjects.size()) +
                               " subjects wilcoxon_exact_holm can never be below " +
                               Short(std::min(1.0, smallest)));
  }
}

void AddEffectSizes(const Blocks& blocks, const AnalysisRequest& request, Findings& findings) {
  const std::vector<double> loadings(blocks.groups.size() - 1, 1 / std::numbers::sqrt2);
  const double z = CriticalZ(loadings, request);
  for (std::size_t i = 1; i < blocks.groups.size(); ++i) {
    const std::vector<double> differences = Differences(blocks, i);
    ordered_json& row = findings.rows[i - 1];
    row["hodges_lehmann"] =
        ToJson(DirectedEffect(PairedHodgesLehmann(differences, z), request.alternative, {}));
    row["cliffs_delta"] =
        ToJson(DirectedEffect(PairedDelta(differences, z), request.alternative, {-1, 1}));
  }
}

Result<void> AddFriedman(const Blocks& blocks, const AnalysisRequest& request, Findings& findings) {
  const auto test = FriedmanTest(blocks, RelabellingOf(request));
  if (!test) return test.error();
  findings.extra["friedman_chi2"] = test->chi_square;
  findings.extra["friedman_df"] = test->degrees;
  findings.extra["friedman_p"] = test->p;
  findings.extra["friedman_permutation_p"] = test->relabelled_p;
  for (std::size_t i = 0; i < test->many_one_z.size(); ++i) {
    findings.rows[i]["friedman_many_one_z"] = test->many_one_z[i];
  }
  return {};
}

/// The permutation test and the block Dunnett test; either can be the p of a row.
Result<void> AddMeanTests(const StudyTable& table, const AnalysisRequest& request,
                          Findings& findings) {
  const bool block = request.method == Method::kAsymptotic;
  const auto dunnett = BlockDunnettTest(*table.blocks, request.alternative, request.confidence);
  if (!dunnett) return dunnett.error();
  const auto permuted =
      PermuteWithinSubjects(*table.blocks, request.alternative, RelabellingOf(request));
  if (!permuted) return permuted.error();
  const Relabelled& relabelled = permuted->relabelled;
  findings.method = NameOf(block ? Method::kAsymptotic : relabelled.method);
  findings.extra["permutation_method"] = NameOf(relabelled.method);
  AddRelabellings(relabelled, request, findings.extra);
  for (std::size_t i = 1; i < table.groups.size(); ++i) {
    const DunnettRow& compared = dunnett->rows[i - 1];
    const RelabelledRow& share = relabelled.rows[i - 1];
    ordered_json row = NewRow(table.groups, i);
    row["estimate"] = compared.estimate;
    row["statistic"] = block ? compared.t : permuted->estimates[i - 1];
    row["df"] = block ? ordered_json(dunnett->degrees) : ordered_json(nullptr);
    row["p"] = block ? compared.p : share.p;
    AddInterval(compared.interval, row);
    row["permutation_p"] = share.p;
    AddRelabelled(share, relabelled.method, row);
    row["block_t"] = compared.t;
    row["block_df"] = dunnett->degrees;
    row["block_dunnett_p"] = compared.p;
    findings.rows.push_back(std::move(row));
  }
  if (dunnett->no_variance) {
    findings.remarks.push_back(
        "all subjects show the same differences, so block_t has no error to be compared with");
  }
  if (relabelled.method == Method::kExact) {
    RemarkOnSmallestP(relabelled.rows, request, findings.remarks);
  }
  return {};
}

ordered_json RatioJson(double estimate, const RateRatio& ratio) {
  return {{"estimate", Number(estimate)},       {"statistic", ratio.statistic},
          {"unadjusted_p", ratio.unadjusted_p}, {"p", ratio.p},
          {"low", Number(ratio.interval.low)},  {"high", Number(ratio.interval.high)}};
}

void RemarkOnDispersion(const Rates& rates, bool exact, std::vector<std::string>& remarks) {
  if (rates.pearson_ratio == 0) return;
  const std::string counts =
      "the counts vary " + Short(rates.pearson_ratio) + " times as much as Poisson counts do";
  if (rates.overdispersion_p >= 0.05) {
    remarks.push_back(counts + ", which does not speak against the Poisson model");
    return;
  }
  remarks.push_back(counts + (exact ? ", so the exact Poisson p are too small: believe the "
                                      "negative binomial ones"
                                    : ", so the Poisson p beside it are too small"));
}

}  // namespace

Result<Findings> ReportPaired(const StudyTable& table, const AnalysisRequest& request) {
  FOOTING_CHECK(table.blocks.has_value());
  Findings findings;
  findings.procedure =
      request.method == Method::kAsymptotic
          ? "Dunnett's test with the subject as a block, by numerical integration"
          : "Labels permuted within each subject, greatest mean difference from the control";
  const Blocks& blocks = *table.blocks;
  if (const auto added = AddMeanTests(table, request, findings); !added) return added.error();
  if (const auto added = AddFriedman(blocks, request, findings); !added) return added.error();
  AddWilcoxon(blocks, request, findings);
  AddEffectSizes(blocks, request, findings);
  findings.extra["subjects"] = blocks.subjects.size();
  return findings;
}

Result<Findings> ReportRate(const StudyTable& table, const AnalysisRequest& request) {
  if (request.method == Method::kPermutation) {
    return UsageError(
        "--test rate has --method exact (Poisson) and asymptotic (negative binomial); for "
        "permutations use --test paired or steel");
  }
  std::vector<Counts> groups;
  for (std::size_t i = 0; i < table.groups.size(); ++i) {
    groups.push_back({table.groups[i].values, table.exposures[i]});
  }
  const Rates rates = CompareRates(groups, request.alternative, request.confidence);
  const bool exact = request.method == Method::kExact;
  Findings findings;
  findings.method = NameOf(exact ? Method::kExact : Method::kAsymptotic);
  findings.procedure =
      exact ? "Poisson rate ratio to the control's, conditional exact test and interval, Holm"
            : "Negative binomial rate ratio to the control's, profile likelihood, Holm";
  findings.extra = {{"model", exact ? "Poisson" : "negative binomial"},
                    {"rates", rates.rates},
                    {"pearson_ratio", rates.pearson_ratio},
                    {"overdispersion_p", rates.overdispersion_p},
                    {"dispersion", rates.dispersion}};
  for (std::size_t i = 1; i < table.groups.size(); ++i) {
    const RateRow& compared = rates.rows[i - 1];
    const ordered_json poisson = RatioJson(compared.ratio, compared.poisson);
    const ordered_json negative_binomial =
        RatioJson(compared.negative_binomial_ratio, compared.negative_binomial);
    ordered_json row = NewRow(table.groups, i);
    row.update(exact ? poisson : negative_binomial);
    row["df"] = nullptr;
    row["poisson"] = poisson;
    row["negative_binomial"] = negative_binomial;
    findings.rows.push_back(std::move(row));
  }
  AddPairedP(table, request, findings.rows);
  RemarkOnDispersion(rates, exact, findings.remarks);
  return findings;
}

}  // namespace footing::statistics
