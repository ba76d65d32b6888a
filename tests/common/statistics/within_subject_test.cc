#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/statistics/dunnett.h"
#include "common/statistics/within_subject.h"

namespace footing::statistics {
namespace {

const double kZ95 = NormalUpperQuantile(0.025);

/// Values with known pairs, unequal sizes.
const std::vector<double> kControl = {1, 4, 4, 7, 9.5};
const std::vector<double> kTreatment = {2, 4, 8, 8, 11, 12.25, 3};

std::vector<double> SortedDifferences(const std::vector<double>& control,
                                      const std::vector<double>& treatment) {
  std::vector<double> differences;
  for (const double x : control) {
    for (const double y : treatment) differences.push_back(y - x);
  }
  std::sort(differences.begin(), differences.end());
  return differences;
}

TEST(HodgesLehmann, IsTheMedianOfAllDifferences) {
  const std::vector<double> all = SortedDifferences(kControl, kTreatment);
  ASSERT_EQ(all.size(), 35u);
  EXPECT_EQ(HodgesLehmann(kControl, kTreatment, kZ95).estimate, all[17]);
  // An even number: the mean of the two in the middle.
  EXPECT_DOUBLE_EQ(HodgesLehmann({1, 2}, {5, 9}, kZ95).estimate, (4.0 + 7) / 2);
}

TEST(HodgesLehmann, EndsAreDifferencesOfTheNormalRank) {
  const std::vector<double> all = SortedDifferences(kControl, kTreatment);
  // floor(35/2 - 1.96 sqrt(35 * 13 / 12) + 1/2) = 5.
  const EffectSize effect = HodgesLehmann(kControl, kTreatment, kZ95);
  EXPECT_EQ(effect.interval.low, all[4]);
  EXPECT_EQ(effect.interval.high, all[30]);
}

TEST(HodgesLehmann, IntervalIsOpenWhereTheGroupsAreTooSmall) {
  const EffectSize effect = HodgesLehmann({1, 2, 3}, {4, 5, 6}, kZ95);
  EXPECT_EQ(effect.estimate, 3);
  EXPECT_TRUE(std::isinf(effect.interval.low) && effect.interval.low < 0);
  EXPECT_TRUE(std::isinf(effect.interval.high) && effect.interval.high > 0);
}

TEST(HodgesLehmann, CopesWithManyTies) {
  const std::vector<double> control(4000, 2), treatment(4000, 2);
  const EffectSize effect = HodgesLehmann(control, treatment, kZ95);
  EXPECT_EQ(effect.estimate, 0);
  EXPECT_EQ(effect.interval.low, 0);
  EXPECT_EQ(effect.interval.high, 0);
}

TEST(PairedHodgesLehmann, AgreesWithR) {
  // wilcox.test(paired = TRUE, conf.int = TRUE) of nine depression scores: 0.46, exact interval
  // 0.010 to 0.786 of ranks 6 and 40; the normal rank is floor(22.5 - 1.96 sqrt(71.25) + 0.5) = 6.
  const std::vector<double> first = {1.83, 0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, 1.30};
  const std::vector<double> second = {0.878, 0.647, 0.598, 2.05, 1.06, 1.29, 1.06, 3.14, 1.29};
  std::vector<double> differences;
  for (std::size_t i = 0; i < 9; ++i) differences.push_back(first[i] - second[i]);
  const EffectSize effect = PairedHodgesLehmann(differences, kZ95);
  EXPECT_NEAR(effect.estimate, 0.46, 1e-12);
  EXPECT_NEAR(effect.interval.low, 0.010, 1e-12);
  EXPECT_NEAR(effect.interval.high, 0.786, 1e-12);
}

TEST(CliffsDelta, CountsPairs) {
  // Values of the control below less those above: 2: 1 - 4; 4: 1 - 2; 8 twice: 4 - 1; 11: 5;
  // 12.25: 5; 3: 1 - 4. In all 21 - 12 of 35 pairs.
  const EffectSize effect = CliffsDelta(kControl, kTreatment, kZ95);
  EXPECT_NEAR(effect.estimate, (21.0 - 12) / 35, 1e-15);
  EXPECT_LT(effect.interval.low, effect.estimate);
  EXPECT_GT(effect.interval.high, effect.estimate);
  EXPECT_GE(effect.interval.low, -1);
  EXPECT_LE(effect.interval.high, 1);
  const EffectSize negative = CliffsDelta(kTreatment, kControl, kZ95);
  EXPECT_NEAR(negative.estimate, -effect.estimate, 1e-15);
  EXPECT_NEAR(negative.interval.low, -effect.interval.high, 1e-14);
}

TEST(CliffsDelta, HasTheVarianceOfItsThreeParts) {
  // Control 0, 2; treatment 1, 3. Pairs +1 (1 > 0), -1 (1 < 2), +1, +1: delta 1/2.
  // Treatment: 0, 1, variance 1/2; control: 1, 0, variance 1/2; pairs: (4 - 4/4) / 1 = 3.
  // Together (1/2 + 1/2 + 3) / 4 = 1.
  const double z = 1;
  const EffectSize effect = CliffsDelta({0, 2}, {1, 3}, z);
  EXPECT_EQ(effect.estimate, 0.5);
  const double rest = 0.75, divisor = rest + 1;
  const double reach = std::sqrt(rest * rest + 1);
  EXPECT_NEAR(effect.interval.low, (0.5 * rest - reach) / divisor, 1e-15);
  EXPECT_NEAR(effect.interval.high, (0.5 * rest + reach) / divisor, 1e-15);
}

TEST(CliffsDelta, OfGroupsApartKeepsAWidth) {
  // Like the share of n successes out of n: (n - z^2) / (n + z^2), n = 3.
  const EffectSize effect = CliffsDelta({1, 2, 3}, {4, 5, 6, 7}, kZ95);
  EXPECT_EQ(effect.estimate, 1);
  EXPECT_EQ(effect.interval.high, 1);
  EXPECT_NEAR(effect.interval.low, (3 - kZ95 * kZ95) / (3 + kZ95 * kZ95), 1e-15);
}

TEST(PairedDelta, CountsSigns) {
  const EffectSize effect = PairedDelta({1, 2, -1, 0, 3}, kZ95);
  EXPECT_NEAR(effect.estimate, 2.0 / 5, 1e-15);
  EXPECT_LT(effect.interval.low, 0);
  EXPECT_GT(effect.interval.high, effect.estimate);
  EXPECT_EQ(PairedDelta({-2, -1}, kZ95).estimate, -1);
}

/// Coverage over many samples: the share of 95 % intervals that hold the true value 0.
TEST(CliffsDelta, IntervalsHoldTheTruthAboutAsOftenAsTheyState) {
  std::uint64_t state = 1;
  const auto draw = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  int held = 0;
  constexpr int kSamples = 2000;
  for (int i = 0; i < kSamples; ++i) {
    std::vector<double> control(15), treatment(15);
    for (double& value : control) value = draw();
    for (double& value : treatment) value = draw();
    const Interval interval = CliffsDelta(control, treatment, kZ95).interval;
    held += interval.low <= 0 && interval.high >= 0 ? 1 : 0;
  }
  EXPECT_NEAR(held / static_cast<double>(kSamples), 0.95, 0.02);
}

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
  EXPECT_NEAR(test.p, std::exp(-3), 1e-15);  // P of a chi-square with 2 degrees of freedom.
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
