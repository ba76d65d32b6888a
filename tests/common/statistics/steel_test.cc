#include "common/statistics/samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/common/statistics/reference.h"

namespace footing::statistics {
namespace {

Relabelling With(Method method) {
  Relabelling relabelling;
  relabelling.method = method;
  return relabelling;
}

Relabelled Exact(const Groups& groups, Alternative alternative, Ties ties = Ties::kPairwise) {
  return SteelRelabelling(groups, alternative, ties, With(Method::kExact)).value();
}

TEST(Steel, ExactPOfSmallExamplesArePinned) {
  EXPECT_NEAR(Exact(test::BloodCounts(), Alternative::kTwoSided).rows[1].p, 0.0258725401582544,
              1e-15);
  EXPECT_NEAR(Exact(test::SmallWithTies(), Alternative::kTwoSided).rows[1].p, 0.0533910533910534,
              1e-15);
}

TEST(Steel, ExactPOfTwoGroupsIsACountOfOrders) {
  // 2 of the 20 ways to choose 3 of 6 ranks put all of one group above the other.
  const Groups apart = {{"control", {1, 2, 3}}, {"a", {4, 5, 6}}};
  EXPECT_NEAR(Exact(apart, Alternative::kTwoSided).rows[0].p, 2.0 / 20, 1e-15);
  EXPECT_NEAR(Exact(apart, Alternative::kGreater).rows[0].p, 1.0 / 20, 1e-15);
  EXPECT_NEAR(Exact(apart, Alternative::kLess).rows[0].p, 1, 1e-15);
  EXPECT_NEAR(Exact(apart, Alternative::kTwoSided).rows[0].smallest_p, 2.0 / 20, 1e-15);
}

TEST(Steel, ThreeInEveryGroupCanNeverReachFivePercent) {
  const Groups groups = {
      {"control", {1, 2, 3}}, {"a", {7, 8, 9}}, {"b", {4, 5, 6}}, {"c", {10, 11, 12}}};
  const Relabelled result = Exact(groups, Alternative::kTwoSided);
  EXPECT_EQ(result.relabellings, 369'600);  // 12! / 3!^4
  for (const RelabelledRow& row : result.rows) {
    EXPECT_GT(row.smallest_p, 0.05);
    EXPECT_GE(row.p, row.smallest_p);
  }
}

TEST(Steel, AsymptoticPAgreesWithQuadratureInEveryRow) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto datasets = test::ReadDatasets();
  const auto rows = test::ReadReference("steel_boost_quadrature.csv");
  ASSERT_GE(rows.size(), 45u);
  const std::pair<const char*, SteelLimit> columns[] = {
      {"p_pairwise_df_inf_steel", {Ties::kPairwise, false, false}},
      {"p_pairwise_finite_corr", {Ties::kPairwise, true, false}},
      {"p_joint", {Ties::kJoint, false, false}},
      {"p_joint_cc", {Ties::kJoint, false, true}}};
  for (const auto& row : rows) {
    const Groups& groups = datasets.at(row.at("dataset"));
    const std::size_t i = std::stoul(row.at("comparison")) - 1;
    for (const auto& [column, limit] : columns) {
      EXPECT_NEAR(SteelAsymptotic(groups, test::AlternativeIn(row), limit)[i],
                  test::NumberIn(row, column), 1e-10)
          << row.at("dataset") << " " << i << " " << column;
    }
    const RankScore pairwise = SteelScores(groups, Ties::kPairwise)[i];
    EXPECT_EQ(pairwise.u, test::NumberIn(row, "U"));
    EXPECT_EQ(pairwise.mean, test::NumberIn(row, "mu"));
    EXPECT_NEAR(pairwise.deviation, test::NumberIn(row, "tau_pairwise_ties"), 1e-12);
    EXPECT_NEAR(pairwise.z, test::NumberIn(row, "z_pairwise"), 1e-12);
    const RankScore joint = SteelScores(groups, Ties::kJoint)[i];
    EXPECT_NEAR(joint.deviation, test::NumberIn(row, "tau_joint_ties"), 1e-12);
    EXPECT_NEAR(joint.z, test::NumberIn(row, "z_joint"), 1e-12);
  }
}

/// p of a row of steel_permutation_cpp.csv in one alternative.
void ExpectPermutationRow(const test::ReferenceRow& row, const Groups& groups, Ties ties,
                          Alternative alternative, const std::string& column) {
  const bool exact = row.at("method") == "exact";
  const auto result = SteelRelabelling(groups, alternative, ties,
                                       With(exact ? Method::kExact : Method::kPermutation));
  ASSERT_TRUE(result) << result.error().message;
  const RelabelledRow& relabelled = result->rows.at(std::stoul(row.at("comparison")) - 1);
  const double p = test::NumberIn(row, column);
  // Both random p deviate by their standard errors; 5 of them.
  const double tolerance =
      exact ? 1e-12 : 5 * std::hypot(test::NumberIn(row, "mc_se_max"), relabelled.standard_error);
  EXPECT_NEAR(relabelled.p, p, tolerance) << row.at("dataset") << " " << column;
  EXPECT_EQ(relabelled.standard_error == 0, exact || relabelled.p == 1);
}

TEST(Steel, RelabellingAgreesWithEnumerationInEveryRow) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto datasets = test::ReadDatasets();
  const auto rows = test::ReadReference("steel_permutation_cpp.csv");
  ASSERT_GE(rows.size(), 15u);
  for (const auto& row : rows) {
    const Groups& groups = datasets.at(row.at("dataset"));
    using enum Alternative;
    ExpectPermutationRow(row, groups, Ties::kPairwise, kTwoSided, "p_pairwise_two");
    ExpectPermutationRow(row, groups, Ties::kPairwise, kGreater, "p_pairwise_greater");
    ExpectPermutationRow(row, groups, Ties::kPairwise, kLess, "p_pairwise_less");
    ExpectPermutationRow(row, groups, Ties::kJoint, kTwoSided, "p_joint_two");
    ExpectPermutationRow(row, groups, Ties::kJoint, kGreater, "p_joint_greater");
    ExpectPermutationRow(row, groups, Ties::kJoint, kLess, "p_joint_less");
  }
}

TEST(Steel, ExactPWithJointTiesAgreesWithR) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto datasets = test::ReadDatasets();
  int compared = 0;
  for (const auto& row : test::ReadReference("steel_R_kSamples.csv")) {
    const std::string& cell = row.at("p_i_exact");
    if (cell.empty() || cell == "NA") continue;  // Too many orders for R.
    const Relabelled result =
        Exact(datasets.at(row.at("dataset")), test::AlternativeIn(row), Ties::kJoint);
    EXPECT_NEAR(result.rows.at(std::stoul(row.at("comparison")) - 1).p,
                test::NumberIn(row, "p_i_exact"), 1e-12);
    ++compared;
  }
  EXPECT_GE(compared, 21);
}

TEST(Steel, TablesOfTiedValuesAreAsGoodAsAllOrders) {
  // Without ties every order is a table of its own, so values a hair apart count them all.
  const Groups tied = {{"control", {1, 1, 2, 3}}, {"a", {2, 2, 3}}, {"b", {1, 3, 3}}};
  const Relabelled result = Exact(tied, Alternative::kTwoSided, Ties::kJoint);
  EXPECT_LT(result.relabellings, 4200);  // 10! / (4! 3! 3!)
  const auto random =
      SteelRelabelling(tied, Alternative::kTwoSided, Ties::kJoint, With(Method::kPermutation));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(result.rows[i].p, random->rows[i].p, 5 * random->rows[i].standard_error);
  }
}

TEST(Steel, TheSeedDecidesTheRandomP) {
  Relabelling relabelling = With(Method::kPermutation);
  relabelling.permutations = 2000;
  const auto run = [&](std::uint64_t seed) {
    relabelling.seed = seed;
    return SteelRelabelling(test::PlantGrowth(), Alternative::kTwoSided, Ties::kPairwise,
                            relabelling)
        ->rows[0]
        .p;
  };
  EXPECT_EQ(run(1), run(1));
  EXPECT_NE(run(1), run(2));
}

TEST(Steel, RandomPIsNeverZeroAndHasItsStandardError) {
  const Groups apart = {{"control", std::vector<double>(15, 0)}, {"a", std::vector<double>(15, 1)}};
  Relabelling relabelling = With(Method::kPermutation);
  relabelling.permutations = 999;
  const auto result = SteelRelabelling(apart, Alternative::kTwoSided, Ties::kPairwise, relabelling);
  // No order of 2 in 155 117 520 turns up in 999 draws: (0 + 1) / (999 + 1).
  EXPECT_DOUBLE_EQ(result->rows[0].p, 0.001);
  EXPECT_DOUBLE_EQ(result->rows[0].standard_error, std::sqrt(0.001 * 0.999 / 999));
}

TEST(Steel, TooManyTablesAreRandomUnlessExactIsAskedFor) {
  const Groups groups = test::PlantGrowth();  // 30 values, hardly tied: 5.6e12 orders.
  const auto refused =
      SteelRelabelling(groups, Alternative::kTwoSided, Ties::kPairwise, With(Method::kExact));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  Relabelling free;
  free.permutations = 100;
  const auto result = SteelRelabelling(groups, Alternative::kTwoSided, Ties::kPairwise, free);
  EXPECT_EQ(result->method, Method::kPermutation);
}

}  // namespace
}  // namespace footing::statistics
