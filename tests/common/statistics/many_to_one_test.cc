#include "common/statistics/many_to_one.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/common/statistics/reference.h"

namespace footing::statistics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kEqualGroups = 1 / std::numbers::sqrt2;

ManyToOne Family(std::vector<double> loadings, double degrees, bool two_sided) {
  return {std::move(loadings), degrees, two_sided};
}

/// With one treatment the loading has no effect: T is Student's t, whose tails for 1, 2 and 4
/// degrees of freedom are elementary functions.
double StudentTail(double t, double degrees) {
  if (degrees == 1) return std::atan(1 / t) / std::numbers::pi;
  if (degrees == 2) return 1 / (std::hypot(t, std::sqrt(2)) * (std::hypot(t, std::sqrt(2)) + t));
  return 0.5 * std::erfc(t / std::numbers::sqrt2);
}

TEST(MaxTail, OfOneTreatmentIsStudentsTailToTenDigitsFarOut) {
  for (const double loading : {0.1, kEqualGroups, 0.95, 0.999}) {
    for (const double degrees : {1.0, 2.0, kInfinity}) {
      for (const double t : {0.3, 1.0, 3.0, 7.0, 12.0, 25.0, 1e3, 1e6, 1e12}) {
        if (std::isinf(degrees) && t > 30) continue;  // Below the smallest double.
        const double tail = StudentTail(t, degrees);
        EXPECT_NEAR(MaxTail(Family({loading}, degrees, false), t) / tail, 1, 1e-10)
            << loading << " " << degrees << " " << t;
        EXPECT_NEAR(MaxTail(Family({loading}, degrees, true), t) / (2 * tail), 1, 1e-10)
            << loading << " " << degrees << " " << t;
      }
    }
  }
}

TEST(MaxTail, AtZeroIsTheChanceThatTheControlIsNotTheGreatest) {
  // Of k + 1 equal groups each is the greatest equally often: 1 - 1 / (k + 1).
  for (int k = 1; k <= 12; ++k) {
    for (const double degrees : {1.0, 7.0, kInfinity}) {
      const std::vector<double> loadings(static_cast<std::size_t>(k), kEqualGroups);
      EXPECT_NEAR(MaxTail(Family(loadings, degrees, false), 0), 1 - 1.0 / (k + 1), 1e-14);
    }
  }
}

TEST(MaxTail, OfManyTreatmentsFarOutIsTheSumOfTheirTails) {
  // P(any) = sum P - P(two at once), and two at once are rarer by orders of magnitude.
  const std::vector<double> loadings = {0.3, 0.5, kEqualGroups};
  for (const double t : {8.0, 12.0}) {
    const double sum = 3 * std::erfc(t / std::numbers::sqrt2);
    EXPECT_NEAR(MaxTail(Family(loadings, kInfinity, true), t) / sum, 1, 1e-6) << t;
  }
}

TEST(MaxTail, GrowsWithTheOrderOfUnequalLoadingsIrrelevant) {
  const double tail = MaxTail(Family({0.2, 0.9, 0.6}, 11, true), 2.2);
  EXPECT_NEAR(MaxTail(Family({0.9, 0.6, 0.2}, 11, true), 2.2), tail, 1e-15);
  EXPECT_GT(MaxTail(Family({0.9, 0.6, 0.2, 0.6}, 11, true), 2.2), tail);
}

TEST(MaxTail, OfManyDegreesIsThatOfTheNormalLimit) {
  const std::vector<double> loadings(4, kEqualGroups);
  const double limit = MaxTail(Family(loadings, kInfinity, true), 2.5);
  // The first correction is of the order 1 / degrees.
  EXPECT_NEAR(MaxTail(Family(loadings, 1e9, true), 2.5), limit, 1e-9);
  EXPECT_NEAR(MaxTail(Family(loadings, 1e4, true), 2.5), limit, 1e-4);
}

TEST(MaxTail, AtTheEndsIsZeroOrOneAndNeverNaN) {
  constexpr double kGreatest = std::numeric_limits<double>::max();
  for (const double degrees : {1.0, 30.0, kInfinity}) {
    for (const double t : {kInfinity, kGreatest}) {
      for (const bool two_sided : {false, true}) {
        const double tail = MaxTail(Family({0.5, 0.8}, degrees, two_sided), t);
        EXPECT_GE(tail, 0);
        EXPECT_LT(tail, 1e-300);
      }
      EXPECT_EQ(MaxTail(Family({0.5, 0.8}, degrees, false), -t), 1);
    }
    EXPECT_EQ(MaxTail(Family({0.5}, degrees, true), 0), 1);
  }
}

TEST(MaxQuantile, FulfilsItsDefinition) {
  for (const double tail : {0.3, 0.05, 1e-4, 1e-9}) {
    for (const double degrees : {1.0, 3.0, 40.0, kInfinity}) {
      for (const bool two_sided : {false, true}) {
        const ManyToOne family = Family({0.4, 0.6, 0.9}, degrees, two_sided);
        EXPECT_NEAR(MaxTail(family, MaxQuantile(family, tail)) / tail, 1, 1e-9);
      }
    }
  }
}

TEST(MaxQuantile, RoundsToDunnettsPrintedTable) {
  // One-sided 5 % points of three treatments (Dunnett 1955): 2.34, 2.19 and 2.06.
  const std::vector<double> three(3, kEqualGroups);
  EXPECT_NEAR(MaxQuantile(Family(three, 10, false), 0.05), 2.34, 0.005);
  EXPECT_NEAR(MaxQuantile(Family(three, 20, false), 0.05), 2.19, 0.005);
  EXPECT_NEAR(MaxQuantile(Family(three, kInfinity, false), 0.05), 2.06, 0.005);
}

TEST(MaxQuantile, AgreesWithTheTableOfCriticalValues) {
  SKIP_WITHOUT_REFERENCE_TABLES();
  const auto rows = test::ReadReference("dunnett_critical_values.csv");
  ASSERT_GE(rows.size(), 100u);
  for (const auto& row : rows) {
    const std::vector<double> loadings(std::stoul(row.at("k_treatments")), kEqualGroups);
    const double degrees = test::NumberIn(row, "df"), alpha = test::NumberIn(row, "alpha");
    EXPECT_NEAR(MaxQuantile(Family(loadings, degrees, true), alpha),
                test::NumberIn(row, "two_sided"), 1e-10);
    EXPECT_NEAR(MaxQuantile(Family(loadings, degrees, false), alpha),
                test::NumberIn(row, "one_sided"), 1e-10);
  }
}

}  // namespace
}  // namespace footing::statistics
