#include "common/statistics/effect_sizes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/statistics/special.h"

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
  // Of treatment: 0, 1, variance 1/2; of control: 1, 0, variance 1/2; of pairs: (4 - 4/4) / 1 = 3.
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

}  // namespace
}  // namespace footing::statistics
