#include "common/statistics/rate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footing::statistics {
namespace {

/// Failures of eight subjects; the figures of R 4.2.2 below are of them.
std::vector<Counts> Failures() {
  const std::vector<double> once(8, 1);
  return {{{5, 9, 2, 14, 7, 3, 11, 6}, once},
          {{2, 4, 1, 6, 3, 0, 5, 2}, once},
          {{8, 3, 10, 4, 12, 6, 1, 9}, once}};
}

TEST(PoissonRate, AgreesWithR) {
  // poisson.test(c(11, 21), c(800, 3011)): interval 0.858426403391639 to 4.277265943654071.
  const std::vector<Counts> groups = {{{6, 8, 7}, {1083, 1050, 878}}, {{11}, {800}}};
  const Rates rates = CompareRates(groups, Alternative::kTwoSided, 0.95);
  EXPECT_NEAR(rates.rows[0].ratio, 1.9714880952381, 1e-13);
  EXPECT_NEAR(rates.rows[0].poisson.interval.low, 0.858426403391639, 1e-9);
  EXPECT_NEAR(rates.rows[0].poisson.interval.high, 4.277265943654071, 1e-9);
  EXPECT_NEAR(rates.rates[1], 11.0 / 800, 1e-17);
}

TEST(PoissonRate, OneSidedPIsABinomialTail) {
  // poisson.test(c(7, 20), c(15, 15), alternative = "less"): p 0.00957864522933959, upper end
  // 0.761499937035099.
  const std::vector<Counts> groups = {{{12, 8}, {10, 5}}, {{3, 4}, {10, 5}}};
  const Rates less = CompareRates(groups, Alternative::kLess, 0.95);
  EXPECT_NEAR(less.rows[0].poisson.p, 0.00957864522933959, 1e-15);
  EXPECT_NEAR(less.rows[0].poisson.interval.high, 0.761499937035099, 1e-9);
  EXPECT_EQ(less.rows[0].poisson.interval.low, 0);
  const Rates greater = CompareRates(groups, Alternative::kGreater, 0.95);
  // P(X >= 7) = 1 - P(X <= 7) + P(X = 7), C(27, 7) = 888030 of 2^27.
  EXPECT_NEAR(greater.rows[0].poisson.p, 1 - 0.00957864522933959 + 888030 / 0x1p27, 1e-12);
  EXPECT_TRUE(std::isinf(greater.rows[0].poisson.interval.high));
}

TEST(PoissonRate, IsAdjustedByHolmAndBonferroni) {
  const Rates two = CompareRates(Failures(), Alternative::kTwoSided, 0.95);
  const RateRatio& wrist = two.rows[0].poisson;
  EXPECT_DOUBLE_EQ(wrist.p, 2 * wrist.unadjusted_p);
  // The interval of two comparisons at 95 % is that of one at 97.5 %.
  const Rates one = CompareRates({Failures()[0], Failures()[1]}, Alternative::kTwoSided, 0.975);
  EXPECT_NEAR(wrist.interval.low, one.rows[0].poisson.interval.low, 1e-12);
  EXPECT_NEAR(wrist.interval.high, one.rows[0].poisson.interval.high, 1e-12);
}

TEST(NegativeBinomialRate, AgreesWithR) {
  // MASS glm.nb: 1 / theta 0.158906791194994; likelihood ratios 7.27867027995578 and
  // 0.0693949836181673; Pearson 1.96389318935841.
  const Rates rates = CompareRates(Failures(), Alternative::kTwoSided, 0.95);
  EXPECT_NEAR(rates.dispersion, 0.158906791194994, 1e-6);
  EXPECT_NEAR(rates.pearson_ratio, 1.96389318935841, 1e-12);
  EXPECT_NEAR(rates.rows[0].negative_binomial_ratio, 23.0 / 57, 1e-12);
  EXPECT_NEAR(rates.rows[0].negative_binomial.statistic, -std::sqrt(7.27867027995578), 1e-7);
  EXPECT_NEAR(rates.rows[1].negative_binomial.statistic, -std::sqrt(0.0693949836181673), 1e-6);
  // Ends of the profile at z of 1 - 0.05 / 4, by optim() and uniroot().
  EXPECT_NEAR(rates.rows[0].negative_binomial.interval.low, 0.189251995836984, 1e-6);
  EXPECT_NEAR(rates.rows[0].negative_binomial.interval.high, 0.843163827830967, 1e-6);
  EXPECT_NEAR(rates.rows[1].negative_binomial.interval.low, 0.476632587188465, 1e-6);
  EXPECT_NEAR(rates.rows[1].negative_binomial.interval.high, 1.81266948439584, 1e-6);
}

TEST(NegativeBinomialRate, WithExposuresAgreesWithR) {
  // glm.nb with offset(log(exposure)).
  std::vector<Counts> groups = Failures();
  groups[0].exposures = groups[1].exposures = {1, 2, 1, 2, 1, 2, 1, 2};
  groups[2].exposures.assign(8, 1.5);
  const Rates rates = CompareRates(groups, Alternative::kTwoSided, 0.95);
  EXPECT_NEAR(rates.dispersion, 0.191278676513015, 1e-6);
  EXPECT_NEAR(rates.rows[0].negative_binomial_ratio, 0.400596380104752, 1e-7);
  EXPECT_NEAR(rates.rows[1].negative_binomial_ratio, 0.890560118121216, 1e-7);
  EXPECT_NEAR(rates.rows[0].negative_binomial.statistic, -std::sqrt(6.63418829251454), 1e-6);
}

TEST(NegativeBinomialRate, WithoutOverdispersionIsPoissons) {
  const std::vector<double> once(4, 1);
  const std::vector<Counts> even = {{{5, 5, 6, 6}, once}, {{2, 3, 2, 3}, once}};
  const Rates rates = CompareRates(even, Alternative::kTwoSided, 0.95);
  EXPECT_EQ(rates.dispersion, 0);
  EXPECT_LT(rates.pearson_ratio, 1);
  // Deviance of 22 : 10 events: 2 (22 log(22/16) + 10 log(10/16)).
  const double deviance = 2 * (22 * std::log(22.0 / 16) + 10 * std::log(10.0 / 16));
  EXPECT_NEAR(rates.rows[0].negative_binomial.statistic, -std::sqrt(deviance), 1e-6);
}

TEST(NegativeBinomialRate, GreatCountsUseTheGammaFunction) {
  // The likelihood ratio depends on the shape only: 5000 and 2500 about their means by 10 %.
  const std::vector<double> once(4, 1);
  const std::vector<Counts> great = {{{5500, 4500, 5400, 4600}, once},
                                     {{2750, 2250, 2700, 2300}, once}};
  const Rates rates = CompareRates(great, Alternative::kTwoSided, 0.95);
  // Squares of the relative deviations: mean 0.0082; less the Poisson part 1 / mean.
  EXPECT_NEAR(rates.dispersion, 0.0082 - 0.5 * (1 / 5000.0 + 1 / 2500.0), 2e-4);
  const Interval interval = rates.rows[0].negative_binomial.interval;
  EXPECT_NEAR(std::sqrt(interval.low * interval.high), 0.5, 1e-3);
}

TEST(Rate, OfGroupsWithoutEventsIsBoundedOnOneSide) {
  const std::vector<double> once(5, 1);
  const Counts none = {{0, 0, 0, 0, 0}, once}, some = {{3, 1, 2, 4, 2}, once};
  for (const auto part : {&RateRow::poisson, &RateRow::negative_binomial}) {
    const RateRow to_none = CompareRates({some, none}, Alternative::kTwoSided, 0.95).rows[0];
    EXPECT_EQ(to_none.ratio, 0);
    EXPECT_EQ((to_none.*part).interval.low, 0);
    EXPECT_LT((to_none.*part).interval.high, 1);
    EXPECT_LT((to_none.*part).p, 0.01);
    const RateRow from_none = CompareRates({none, some}, Alternative::kTwoSided, 0.95).rows[0];
    EXPECT_TRUE(std::isinf(from_none.ratio));
    EXPECT_GT((from_none.*part).interval.low, 1);
    EXPECT_TRUE(std::isinf((from_none.*part).interval.high));
    const RateRow both = CompareRates({none, none}, Alternative::kTwoSided, 0.95).rows[0];
    EXPECT_TRUE(std::isnan(both.ratio));
    EXPECT_EQ((both.*part).p, 1);
    EXPECT_EQ((both.*part).interval.low, 0);
  }
}

}  // namespace
}  // namespace footing::statistics
