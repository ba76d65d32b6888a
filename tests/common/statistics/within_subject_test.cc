#include "common/statistics/within_subject.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/statistics/dunnett.h"

namespace footing::statistics {
namespace {

Relabelling Using(Method method) {
  Relabelling relabelling;
  relabelling.method = method;
  return relabelling;
}

/// Ratings of six subjects, with ties. The figures of R 4.2.2 below are of this table.
Blocks Ratings() {
  return {{"joystick", "wrist", "arm", "leg"},
          {"1", "2", "3", "4", "5", "6"},
          {{3, 4, 5, 4}, {2, 2, 4, 5}, {3, 5, 4, 3}, {1, 2, 3, 3}, {4, 4, 5, 5}, {2, 3, 3, 4}}};
}

TEST(PermuteWithinSubjects, OfOneTreatmentIsTheSignTestOfMeans) {
  // Differences 1, 2, 3: of 2^3 signs only +++ and --- reach the mean 2.
  const Blocks blocks = {{"control", "a"}, {"1", "2", "3"}, {{5, 6}, {1, 3}, {2, 5}}};
  const auto two =
      PermuteWithinSubjects(blocks, Alternative::kTwoSided, Using(Method::kExact)).value();
  EXPECT_DOUBLE_EQ(two.estimates[0], 2);
  EXPECT_DOUBLE_EQ(two.relabelled.rows[0].p, 2.0 / 8);
  EXPECT_DOUBLE_EQ(two.relabelled.rows[0].smallest_p, 2.0 / 8);
  const auto less =
      PermuteWithinSubjects(blocks, Alternative::kLess, Using(Method::kExact)).value();
  EXPECT_DOUBLE_EQ(less.relabelled.rows[0].p, 1);
  const auto greater =
      PermuteWithinSubjects(blocks, Alternative::kGreater, Using(Method::kExact)).value();
  EXPECT_DOUBLE_EQ(greater.relabelled.rows[0].p, 1.0 / 8);
}

TEST(PermuteWithinSubjects, CountsTheOrdersOfThreeGroups) {
  // Two subjects, each with 0, 0, 1 in another order: 3 x 3 tables. The sums less the control's:
  // (1,1) at a: a reaches 2; the same at b; (1,1) at the control: both -2; the six others: +-1.
  const Blocks blocks = {{"control", "a", "b"}, {"1", "2"}, {{0, 1, 0}, {0, 1, 0}}};
  const auto result =
      PermuteWithinSubjects(blocks, Alternative::kTwoSided, Using(Method::kExact)).value();
  EXPECT_EQ(result.relabelled.relabellings, 9);
  EXPECT_DOUBLE_EQ(result.relabelled.rows[0].p, 3.0 / 9);
  EXPECT_DOUBLE_EQ(result.relabelled.rows[1].p, 1);
}

TEST(PermuteWithinSubjects, RandomOrdersAgreeWithAllOrders) {
  Blocks four = Ratings();
  four.values.resize(4);
  four.subjects.resize(4);
  for (const auto alternative :
       {Alternative::kTwoSided, Alternative::kGreater, Alternative::kLess}) {
    const auto exact = PermuteWithinSubjects(four, alternative, Using(Method::kExact)).value();
    const auto random =
        PermuteWithinSubjects(four, alternative, Using(Method::kPermutation)).value();
    for (std::size_t i = 0; i < 3; ++i) {
      const RelabelledRow& row = random.relabelled.rows[i];
      EXPECT_NEAR(row.p, exact.relabelled.rows[i].p, 5 * row.standard_error + 2e-5);
    }
  }
}

TEST(Friedman, AgreesWithR) {
  // friedman.test(): 10.5849056603774, p 0.0141958572259251.
  const Friedman test = FriedmanTest(Ratings(), Using(Method::kPermutation)).value();
  EXPECT_NEAR(test.chi_square, 10.5849056603774, 1e-12);
  EXPECT_EQ(test.degrees, 3);
  EXPECT_NEAR(test.p, 0.0141958572259251, 1e-14);
  // Rank sums 7.5, 14, 19.5, 19; deviation sqrt(6 * 4 * 5 / 6).
  EXPECT_NEAR(test.many_one_z[0], 6.5 / std::sqrt(20), 1e-14);
  EXPECT_NEAR(test.many_one_z[1], 12 / std::sqrt(20), 1e-14);
  EXPECT_NEAR(test.many_one_z[2], 11.5 / std::sqrt(20), 1e-14);
}

TEST(Friedman, ExactPCountsOrders) {
  // Three subjects agree on the order of three groups: 6 of the 6^3 orders agree as well.
  const Blocks blocks = {{"control", "a", "b"}, {"1", "2", "3"}, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}};
  const Friedman test = FriedmanTest(blocks, Using(Method::kExact)).value();
  EXPECT_NEAR(test.chi_square, 6, 1e-12);
  EXPECT_NEAR(test.relabelled_p, 6.0 / 216, 1e-15);
  EXPECT_NEAR(test.p, std::exp(-3), 1e-15);  // Of a chi-square with 2 degrees of freedom.
}

TEST(BlockDunnett, AgreesWithinItsErrorWithR) {
  // glht(aov(y ~ group + subject), mcp("Dunnett")): t and df; p of the lattice rule, error 6e-4.
  const auto test = BlockDunnettTest(Ratings(), Alternative::kTwoSided, 0.95).value();
  EXPECT_EQ(test.degrees, 15);
  EXPECT_NEAR(test.rows[0].t, 1.96116135138184, 1e-13);
  EXPECT_NEAR(test.rows[1].t, 3.53009043248731, 1e-13);
  EXPECT_NEAR(test.rows[0].p, 0.16273267, 1e-3);
  EXPECT_NEAR(test.rows[1].p, 0.00821133, 1e-3);
}

TEST(Wilcoxon, WithTiesAndZerosAgreesWithR) {
  // wilcox.test(paired = TRUE) of each treatment.
  const double two_sided[] = {0.0889730117018133, 0.0320148572831348, 0.0567594463860135};
  const double greater[] = {0.0444865058509067, 0.0160074286415674, 0.0283797231930068};
  const double less[] = {0.981182343106343, 0.990829167357964, 0.985271807183714};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> differences = Differences(Ratings(), i + 1);
    EXPECT_NEAR(WilcoxonTest(differences, Alternative::kTwoSided).p, two_sided[i], 1e-13);
    EXPECT_NEAR(WilcoxonTest(differences, Alternative::kGreater).p, greater[i], 1e-13);
    EXPECT_NEAR(WilcoxonTest(differences, Alternative::kLess).p, less[i], 1e-13);
  }
}

TEST(Wilcoxon, WithoutTiesIsExactAsInR) {
  // Depression scores of the manual of wilcox.test (Hollander & Wolfe 1973): 0.0390625 etc.
  const std::vector<double> first = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::vector<double> second = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (std::size_t i = 0; i < 9; ++i) differences.push_back(first[i] - second[i]);
  EXPECT_DOUBLE_EQ(WilcoxonTest(differences, Alternative::kTwoSided).p, 0.0390625);
  EXPECT_DOUBLE_EQ(WilcoxonTest(differences, Alternative::kGreater).p, 0.01953125);
  EXPECT_DOUBLE_EQ(WilcoxonTest(differences, Alternative::kLess).p, 0.986328125);
  EXPECT_EQ(WilcoxonTest(differences, Alternative::kGreater).v, 40);
}

TEST(Wilcoxon, ExactPWithTiesCountsSigns) {
  // Sizes 1, 1, 2 have the ranks 1.5, 1.5, 3. V = 6 of (+,+,+); V >= 4.5: also (-,+,+), (+,-,+).
  EXPECT_DOUBLE_EQ(WilcoxonTest({1, 1, 2}, Alternative::kGreater).exact_p, 1.0 / 8);
  EXPECT_DOUBLE_EQ(WilcoxonTest({-1, 1, 2}, Alternative::kGreater).exact_p, 3.0 / 8);
  EXPECT_DOUBLE_EQ(WilcoxonTest({-1, 1, 2}, Alternative::kTwoSided).exact_p, 6.0 / 8);
  EXPECT_DOUBLE_EQ(WilcoxonTest({0, 1, 1, 0, 2}, Alternative::kGreater).exact_p, 1.0 / 8);
}

TEST(Wilcoxon, SizesThatDifferByRoundingAreTied) {
  // 0.3 - 0.1 and 0.2 differ in the last bit: 3 of 8 signs reach V = 4.5 when they are tied.
  EXPECT_DOUBLE_EQ(WilcoxonTest({0.1 - 0.3, 0.2, 1}, Alternative::kGreater).exact_p, 3.0 / 8);
}

TEST(Holm, StepsDownAndStaysMonotone) {
  // Sorted 0.01 x 4, 0.02 x 3, 0.03 x 2 = 0.06 again, 0.5 x 1.
  const std::vector<double> adjusted = Holm({0.03, 0.01, 0.5, 0.02});
  EXPECT_DOUBLE_EQ(adjusted[1], 0.04);
  EXPECT_DOUBLE_EQ(adjusted[3], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[0], 0.06);
  EXPECT_DOUBLE_EQ(adjusted[2], 0.5);
  EXPECT_EQ(Holm({0.9, 0.8}), (std::vector<double>{1, 1}));
}

}  // namespace
}  // namespace footing::statistics
