#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/result.h"
#include "common/statistics/relabelling.h"
#include "common/statistics/samples.h"

namespace footing::statistics {

/// Which ties the deviation of a rank statistic allows for: those of the two groups compared
/// (Steel's own), or those of all groups together, which are fixed under relabelling.
enum class Ties { kPairwise, kJoint };

/// One treatment against the control.
///
///   | symbol | name here | meaning                                                        |
///   | U_i    | u         | pairs with the treatment's value greater; a tie counts half    |
///   |        | mean      | n_0 n_i / 2, what U_i is on average where nothing differs      |
///   |        | deviation | standard deviation of U_i where nothing differs, given the ties |
///   | z_i    | z         | (u - mean) / deviation; 0 where all values are equal           |
struct RankScore {
  double u = 0;
  double mean = 0;
  double deviation = 0;
  double z = 0;
};

std::vector<RankScore> SteelScores(const Groups& groups, Ties ties);

/// The limit distribution of max z_i: z_i become normal, with correlations l_i l_j.
struct SteelLimit {
  Ties ties = Ties::kPairwise;
  /// With pairwise ties: l_i^2 = n_i / (n_i + n_0 + 1), exact for finite groups without ties, in
  /// place of n_i / (n_i + n_0), which the printed tables use. Joint ties have the exact value.
  bool finite_sample = false;
  bool continuity = false;  ///< U_i is moved half a pair towards its mean.
};

/// Adjusted p of every treatment by the limit distribution.
std::vector<double> SteelAsymptotic(const Groups& groups, Alternative alternative,
                                    const SteelLimit& limit);

/// Adjusted p of every treatment by relabelling all values: the share of relabellings with
/// max z_j >= z_i. Exact enumeration (UsageError if there are too many tables), or random ones.
Result<Relabelled> SteelRelabelling(const Groups& groups, Alternative alternative, Ties ties,
                                    const Relabelling& relabelling);

}  // namespace footing::statistics
