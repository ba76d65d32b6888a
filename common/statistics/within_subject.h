#pragma once

#include <vector>

#include "common/base/result.h"
#include "common/statistics/relabelling.h"
#include "common/statistics/samples.h"

/// Tests for designs where every subject has one value in every group.
namespace footing::statistics {

/// Mean of each treatment less the control's, with adjusted p: labels are permuted within each
/// subject, and the evidence is the greatest (absolute) difference of means.
struct MeanDifferences {
  std::vector<double> estimates;
  Relabelled relabelled;
};
Result<MeanDifferences> PermuteWithinSubjects(const Blocks& blocks, Alternative alternative,
                                              const Relabelling& relabelling);

/// Does any group differ? Ranks within each subject; ties share their mean rank.
struct Friedman {
  double chi_square = 0;  ///< With the correction for ties; 0 where all ranks are tied.
  double degrees = 0;
  double p = 1;             ///< By the chi-square distribution.
  double relabelled_p = 1;  ///< By relabelling within subjects.
  /// (R_i - R_0) / sqrt(n g (g + 1) / 6) of each treatment, with rank sums R and g groups.
  std::vector<double> many_one_z;
};
Result<Friedman> FriedmanTest(const Blocks& blocks, const Relabelling& relabelling);

/// Wilcoxon's signed ranks of one list of differences.
struct SignedRanks {
  double v = 0;        ///< Sum of the ranks of positive differences; zeros are left out.
  double exact_p = 1;  ///< Over all signs, with ties as they are. Normal above 200 differences.
  /// As R's wilcox.test: exact below 50 differences without ties or zeros, otherwise normal with
  /// continuity and tie corrections.
  double p = 1;
};
SignedRanks WilcoxonTest(const std::vector<double>& differences, Alternative alternative);

/// Holm's step-down adjustment.
std::vector<double> Holm(const std::vector<double>& p);

/// Of a treatment (index in `blocks.groups`) less the control, one for each subject. What is left
/// of equal values by rounding counts as 0.
std::vector<double> Differences(const Blocks& blocks, std::size_t treatment);

}  // namespace footing::statistics
