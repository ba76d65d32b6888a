#include "common/statistics/dunnett.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/common/statistics/reference.h"

namespace footing::statistics {
namespace {

constexpr double kConfidence = 0.95;

Dunnett RunDunnett(const Groups& groups, Alternative alternative = Alternative::kTwoSided) {
  return DunnettTest(groups, alternative, kConfidence).value();
}

TEST(Dunnett, OfBloodCountsAndPlantsHasThePublishedP) {
  const Dunnett blood = RunDunnett(test::BloodCounts());
  EXPECT_EQ(blood.degrees, 12);
  EXPECT_NEAR(blood.rows[0].p, 0.620101980018456, 1e-12);
  EXPECT_NEAR(blood.rows[1].p, 0.00582536084794693, 1e-12);
  const Dunnett plants = RunDunnett(test::PlantGrowth());
  EXPECT_NEAR(plants.rows[0].p, 0.322695685768781, 1e-12);
  EXPECT_NEAR(plants.rows[1].p, 0.153485861515125, 1e-12);
}

TEST(Dunnett, AgreesWithQuadratureInEveryRow) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto datasets = test::ReadDatasets();
  const auto rows = test::ReadReference("dunnett_boost_quadrature.csv");
  ASSERT_GE(rows.size(), 45u);
  for (const auto& row : rows) {
    const Dunnett result = RunDunnett(datasets.at(row.at("dataset")), test::AlternativeIn(row));
    const DunnettRow& compared = result.rows.at(std::stoul(row.at("comparison")) - 1);
    const std::string where = row.at("dataset") + " " + row.at("comparison");
    EXPECT_NEAR(compared.estimate, test::NumberIn(row, "estimate"), 1e-12) << where;
    EXPECT_NEAR(compared.standard_error, test::NumberIn(row, "stderr"), 1e-12) << where;
    EXPECT_NEAR(compared.t, test::NumberIn(row, "t"), 1e-11) << where;
    EXPECT_EQ(result.degrees, test::NumberIn(row, "df")) << where;
    const double p = test::NumberIn(row, "p");
    EXPECT_NEAR(compared.p, p, 1e-12) << where;
    EXPECT_NEAR(compared.p / p, 1, 1e-9) << where;
  }
}

TEST(Dunnett, AgreesWithOtherNodesAndWithinItsErrorWithR) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto datasets = test::ReadDatasets();
  for (const char* const table : {"dunnett_numpy_check.csv", "dunnett_R_multcomp.csv"}) {
    const bool r = std::string(table) == "dunnett_R_multcomp.csv";
    for (const auto& row : test::ReadReference(table)) {
      const Dunnett result = RunDunnett(datasets.at(row.at("dataset")), test::AlternativeIn(row));
      const double p = result.rows.at(std::stoul(row.at("comparison")) - 1).p;
      // R's lattice rule states its error; three times that.
      const double tolerance = r ? 1e-12 + 3 * test::NumberIn(row, "mvt_error") : 1e-10;
      EXPECT_NEAR(p, test::NumberIn(row, r ? "p_single_step" : "p"), tolerance)
          << row.at("dataset") << " " << row.at("comparison");
    }
  }
}

TEST(Dunnett, IntervalsExcludeZeroWherePIsBelowTheLevel) {
  for (const Groups& groups : {test::BloodCounts(), test::PlantGrowth(), test::SmallWithTies()}) {
    for (const auto alternative :
         {Alternative::kTwoSided, Alternative::kGreater, Alternative::kLess}) {
      for (const DunnettRow& row : RunDunnett(groups, alternative).rows) {
        const bool excluded = row.interval.low > 0 || row.interval.high < 0;
        EXPECT_EQ(excluded, row.p < 1 - kConfidence);
        EXPECT_LE(row.interval.low, row.estimate);
        EXPECT_GE(row.interval.high, row.estimate);
      }
    }
  }
  EXPECT_TRUE(
      std::isinf(RunDunnett(test::BloodCounts(), Alternative::kGreater).rows[0].interval.high));
  EXPECT_TRUE(std::isinf(RunDunnett(test::BloodCounts(), Alternative::kLess).rows[0].interval.low));
}

TEST(Dunnett, KeepsTheDigitsOfATinyP) {
  // Two groups: Student's t with 2 degrees of freedom, whose tail is elementary.
  const Groups groups = {{"control", {0, 2e-6}}, {"far", {1, 1 + 2e-6}}};
  const Dunnett result = RunDunnett(groups);
  const double root = std::hypot(result.rows[0].t, std::sqrt(2));
  const double p = 2 / (root * (root + result.rows[0].t));
  EXPECT_LT(p, 3e-12);
  EXPECT_NEAR(result.rows[0].p / p, 1, 1e-9);
}

TEST(Dunnett, NeedsAGroupWithTwoValues) {
  const Groups groups = {{"control", {1}}, {"a", {2}}};
  const auto result = DunnettTest(groups, Alternative::kTwoSided, kConfidence);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kInvalidData);
}

/// Three subjects, two treatments: the residuals are written out below.
Blocks ThreeSubjects() {
  return {{"control", "a", "b"}, {"s1", "s2", "s3"}, {{1, 2, 6}, {4, 6, 8}, {10, 10, 13}}};
}

TEST(BlockDunnett, RemovesTheSubjectsMeans) {
  const auto result = BlockDunnettTest(ThreeSubjects(), Alternative::kTwoSided, kConfidence);
  ASSERT_TRUE(result);
  // Means of subjects 3, 6, 11; of groups 5, 6, 9; of all 20/3. Residuals
  // x - subject - group + all: -1/3 -1/3 2/3, -1/3 2/3 -1/3, 2/3 -1/3 -1/3: squares sum to 2.
  EXPECT_EQ(result->degrees, 4);
  const double standard_error = std::sqrt(2.0 / 4 * 2 / 3);
  EXPECT_NEAR(result->rows[0].standard_error, standard_error, 1e-15);
  EXPECT_NEAR(result->rows[0].t, 1 / standard_error, 1e-14);
  EXPECT_NEAR(result->rows[1].t, 4 / standard_error, 1e-14);
}

TEST(BlockDunnett, IsBlindToASubjectsLevel) {
  const auto plain = BlockDunnettTest(ThreeSubjects(), Alternative::kTwoSided, kConfidence);
  Blocks raised = ThreeSubjects();
  for (double& value : raised.values[1]) value += 1000;
  const auto other = BlockDunnettTest(raised, Alternative::kTwoSided, kConfidence);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(other->rows[i].p, plain->rows[i].p, 1e-12);
}

TEST(BlockDunnett, OfOneTreatmentIsThePairedTTest) {
  // Differences 1, 2, 0, 3: mean 1.5, deviation sqrt(5/3), t = 1.5 / sqrt(5/12).
  const Blocks blocks = {{"control", "a"}, {"1", "2", "3", "4"}, {{5, 6}, {2, 4}, {7, 7}, {1, 4}}};
  const auto result = BlockDunnettTest(blocks, Alternative::kTwoSided, kConfidence);
  EXPECT_EQ(result->degrees, 3);
  EXPECT_NEAR(result->rows[0].t, 1.5 / std::sqrt(5.0 / 12), 1e-14);
  // Student's tail for 3 degrees of freedom, theta = atan(t / sqrt 3):
  // 1 - 2/pi (theta + sin theta cos theta).
  const double theta = std::atan(result->rows[0].t / std::sqrt(3));
  EXPECT_NEAR(result->rows[0].p,
              1 - 2 / std::numbers::pi * (theta + std::sin(theta) * std::cos(theta)), 1e-13);
}

}  // namespace
}  // namespace footing::statistics
