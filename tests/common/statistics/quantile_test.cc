#include "common/statistics/quantile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/statistics/ranks.h"

namespace footing::statistics {
namespace {

using testing::ElementsAre;

// R: quantile(c(7, 1, 3, 2), c(0, 0.25, 0.5, 0.95, 1)).
TEST(Quantile, IsLinearBetweenTheTwoNearestValues) {
  const std::vector<double> values = {7, 1, 3, 2};
  EXPECT_EQ(QuantileOf(values, 0), 1);
  EXPECT_DOUBLE_EQ(QuantileOf(values, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(QuantileOf(values, 0.95), 6.4);
  EXPECT_EQ(QuantileOf(values, 1), 7);
  EXPECT_EQ(MedianOf(values), 2.5);
  EXPECT_EQ(MedianOf({5}), 5);
}

TEST(MeanRanks, TiedValuesShareTheMeanOfTheirRanks) {
  const MeanRanks ranked = RankWithTies({-1, 4, -1, 0, 4, 4});
  EXPECT_THAT(ranked.ranks, ElementsAre(1.5, 5, 1.5, 3, 5, 5));
  EXPECT_EQ(ranked.tie_sum, (8 - 2) + (27 - 3));
}

TEST(MeanRanks, ValuesThatDifferByRoundingAreTiedWhereThatIsAsked) {
  const std::vector<double> values = {0.3 - 0.1, 0.2, 0.25};
  ASSERT_NE(values[0], values[1]);
  EXPECT_EQ(RankWithTies(values).tie_sum, 0);
  EXPECT_THAT(RankWithTies(values, 1e-12).ranks, ElementsAre(1.5, 1.5, 3));
}

}  // namespace
}  // namespace footing::statistics
