#include "daemon/offline/tune/search.h"

#include <gtest/gtest.h>

#include <cmath>

#include "daemon/offline/tune/search_space.h"

namespace footing::tune {
namespace {

using Eigen::VectorXd;

constexpr int kDimensions = 6;

/// A bent bowl, narrow along some axes, with its lowest point away from the start.
double Bowl(const VectorXd& x) {
  double value = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double wanted = i % 2 == 0 ? 1.5 : -2;
    value += (1 + static_cast<double>(i)) * (x[i] - wanted) * (x[i] - wanted);
  }
  return value;
}

Evaluate Counting(int& evaluated) {
  return [&evaluated](const std::vector<VectorXd>& points, std::uint64_t) {
    std::vector<double> values;
    for (const VectorXd& point : points) values.push_back(Bowl(point));
    evaluated += static_cast<int>(points.size());
    return values;
  };
}

TEST(Descent, FindsTheLowestPointOfABowl) {
  SearchState state = StartSearch(kDimensions);
  int evaluated = 0;
  for (int i = 0; i < 40; ++i) Descend(state, Counting(evaluated));
  EXPECT_LT(Bowl(state.point), 0.05 * Bowl(VectorXd::Zero(kDimensions)));
  EXPECT_EQ(evaluated, 40 * DescentPoints(kDimensions));
}

TEST(Descent, NeverTakesAWorsePointOfTheSameTrials) {
  SearchState state = StartSearch(kDimensions);
  int evaluated = 0;
  double before = Bowl(state.point);
  for (int i = 0; i < 20; ++i) {
    Descend(state, Counting(evaluated));
    EXPECT_LE(Bowl(state.point), before);
    before = Bowl(state.point);
  }
}

TEST(Descent, StaysWhereNothingMatters) {
  SearchState state = StartSearch(2);
  Descend(state, [](const auto& points, std::uint64_t) {
    return std::vector<double>(points.size(), 3.0);
  });
  EXPECT_EQ(state.point.norm(), 0);
  EXPECT_EQ(state.iteration, 1);
}

TEST(Evolution, FindsTheLowestPointOfATurnedValley) {
  // Rosenbrock's function in four dimensions: needs the covariance, not only the step.
  const auto valley = [](const VectorXd& x) {
    double value = 0;
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      value += 100 * std::pow(x[i + 1] - x[i] * x[i], 2) + std::pow(1 - x[i], 2);
    }
    return value;
  };
  SearchState state = StartSearch(4);
  for (int i = 0; i < 400; ++i) {
    Evolve(
        state,
        [&](const std::vector<VectorXd>& points, std::uint64_t) {
          std::vector<double> values;
          for (const VectorXd& point : points) values.push_back(valley(point));
          return values;
        },
        7);
  }
  EXPECT_LT(valley(state.point), 1e-6);
  EXPECT_NEAR(state.point[3], 1, 1e-2);
}

TEST(Evolution, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const auto after = [](std::uint64_t seed) {
    SearchState state = StartSearch(kDimensions);
    int evaluated = 0;
    for (int i = 0; i < 5; ++i) Evolve(state, Counting(evaluated), seed);
    EXPECT_EQ(evaluated, 5 * EvolutionPoints(kDimensions));
    return state.point;
  };
  EXPECT_EQ(after(1), after(1));
  EXPECT_NE(after(1), after(2));
}

TEST(SearchSpace, TheStartIsZeroAndStepsAreOfTheGainsSize) {
  const gait::Gains start;
  for (const stream::Gait gait :
       {stream::Gait::kStep, stream::Gait::kWalk, stream::Gait::kRun, stream::Gait::kJump}) {
    const auto dimensions = DimensionsOf(gait);
    const auto n = static_cast<Eigen::Index>(dimensions.size());
    EXPECT_GE(n, 12);
    const gait::Gains same = GainsAt(start, dimensions, VectorXd::Zero(n));
    const gait::Gains other = GainsAt(start, dimensions, VectorXd::Ones(n));
    const gait::Gains far = GainsAt(start, dimensions, VectorXd::Constant(n, -1e3));
    for (const Dimension& dimension : dimensions) {
      const double now = dimension.gain->Of(start), step = dimension.gain->Of(other) - now;
      EXPECT_EQ(dimension.gain->Of(same), now);
      EXPECT_NE(step, 0) << dimension.gain->name;
      EXPECT_LT(std::fabs(step), 0.3 * std::fabs(now)) << dimension.gain->name;
      EXPECT_GE(dimension.gain->Of(far), dimension.gain->min) << dimension.gain->name;
    }
  }
}

}  // namespace
}  // namespace footing::tune
