#include "common/statistics/dunnett.h"

#include <limits>
#include <string>

#include "common/statistics/many_to_one.h"
#include "common/statistics/moments.h"

namespace footing::statistics {
namespace {

/// What both designs come down to.
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

}  // namespace footing::statistics
