#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "daemon/offline/tune/team.h"

namespace footing::tune {
namespace {

const RunKey kKey{"walk", {0.5, 1.5}, 7, "cmaes", 24, 1, false, "gains"};

std::vector<double> Roughly(const std::vector<Eigen::VectorXd>& points) {
  std::vector<double> values;
  for (const auto& point : points) values.push_back(std::sin(point.sum()) + point.squaredNorm());
  return values;
}

std::vector<SearchState> Searched() {
  std::vector<SearchState> searches{StartSearch(3), StartSearch(3)};
  for (int i = 0; i < 4; ++i) {
    Evolve(
        searches[0], [](const auto& points, std::uint64_t) { return Roughly(points); }, 5);
  }
  return searches;
}

TEST(KeptRun, GoesOnBitForBit) {
  auto unbroken = Searched();
  auto resumed = ResumeRun(KeepRun(kKey, unbroken), kKey, "x");
  ASSERT_TRUE(resumed.ok()) << resumed.error().message;
  ASSERT_EQ(resumed->size(), 2u);
  const auto evaluate = [](const auto& points, std::uint64_t) { return Roughly(points); };
  for (int i = 0; i < 4; ++i) {
    Evolve(unbroken[0], evaluate, 5);
    Evolve((*resumed)[0], evaluate, 5);
  }
  EXPECT_EQ((*resumed)[0].point, unbroken[0].point);
  EXPECT_EQ((*resumed)[0].covariance, unbroken[0].covariance);
  EXPECT_EQ((*resumed)[0].step, unbroken[0].step);
  EXPECT_EQ((*resumed)[0].history.size(), 8u);
}

TEST(KeptRun, RefusesAnotherRunsStateAndSaysWhatDiffers) {
  RunKey other = kKey;
  other.seed = 8;
  const auto resumed = ResumeRun(KeepRun(kKey, Searched()), other, "walk.csv.state.json");
  ASSERT_FALSE(resumed.ok());
  EXPECT_EQ(resumed.error().message,
            "walk.csv.state.json is of a run with another seed; remove it to start again, or name "
            "another --out");
}

TEST(KeptRun, RefusesDamagedText) {
  const std::string whole = KeepRun(kKey, Searched());
  std::string short_point = whole;
  short_point.replace(short_point.find("\"step_path\""), 12, "\"step_path_\":");
  for (const std::string& text : {std::string(), std::string("[]"), whole.substr(0, 200),
                                  std::string("{\"key\": 3}"), short_point}) {
    const auto resumed = ResumeRun(text, kKey, "state");
    ASSERT_FALSE(resumed.ok()) << text;
    EXPECT_EQ(resumed.error().kind, ErrorKind::kInvalidData);
  }
}

constexpr Task kWalk{stream::Gait::kWalk, 1.0};

TrialResult AsWanted(const Task& task) {
  const Wanted wanted = WantedOf(task, 0.2);
  return {.survived = 1,
          .speed_error_mps = 0,
          .flight_s = wanted.flight_s,
          .stance_s = wanted.stance_s,
          .stride_m = wanted.stride_m};
}

TEST(Objective, IsNothingWhenAllIsAsWanted) {
  for (const Task& task : {kWalk, Task{stream::Gait::kStep, 0}, Task{stream::Gait::kRun, 3},
                           Task{stream::Gait::kJump, 0.5}}) {
    EXPECT_NEAR(CostOf(task, AsWanted(task)).total(), 0, 1e-12);
  }
}

TEST(Objective, ChargesTwentyForAFallAtOnceAndTenForTheLatest) {
  TrialResult result = AsWanted(kWalk);
  result.survived = 0;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).total(), 20);
  result.survived = 0.75;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).failure, 10 + 10 * 0.25);
}

TEST(Objective, ChargesThePapersGaitsForAChangeThatNeverCame) {
  TrialResult result = AsWanted(kWalk);
  result.reached = false;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).failure, 0);
  Task paper = kWalk;
  paper.paper = true;
  EXPECT_DOUBLE_EQ(CostOf(paper, result).failure, 10);
}

TEST(Objective, ChargesTheLatestFallMoreThanAllElseTogether) {
  TrialResult worst{.survived = 1,
                    .speed_error_mps = 9,
                    .flight_s = 9,
                    .stance_s = 9,
                    .stride_m = 99,
                    .heading_error_rad = 3,
                    .leg_gap_m = -0.04};
  const Task run{stream::Gait::kRun, 3};
  TrialResult worst_change = worst;
  worst_change.heading_error_rad = 0;  // Only turns have a heading error.
  worst_change.latency_s = 5;
  TrialResult fallen = AsWanted(run);
  fallen.survived = 0.9999;
  for (const TrialResult& bad : {worst, worst_change}) {
    const double all_else = CostOf(run, bad).total();
    EXPECT_GT(all_else, 8);
    EXPECT_GT(CostOf(run, fallen).total(), all_else);
  }
}

TEST(Objective, ChargesEachTermByItself) {
  TrialResult result = AsWanted(kWalk);
  result.speed_error_mps = 0.15;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).speed, 1);
  result.speed_error_mps = 5;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).speed, 2);
  result.flight_s *= 1.1;
  EXPECT_NEAR(CostOf(kWalk, result).flight, 0.25, 1e-12);
  result.stance_s *= 0.5;
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).stance, 1);
  result.stride_m *= 1.2;
  EXPECT_NEAR(CostOf(kWalk, result).stride, 1, 1e-12);
  result.heading_error_rad = DegreesToRadians(2.5);
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).heading, 0.25);
}

TEST(Objective, ChargesTheLegsOfARunThatComeTooNear) {
  const Task run{stream::Gait::kRun, 3};
  TrialResult result = AsWanted(run);
  result.leg_gap_m = 0.03;
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 0);
  result.leg_gap_m = 0;
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 1);
  result.leg_gap_m = -0.04;  // One through the other.
  EXPECT_DOUBLE_EQ(CostOf(run, result).legs, 2);
  // A walk steps across where balance asks for it.
  EXPECT_DOUBLE_EQ(CostOf(kWalk, result).legs, 0);
}

TEST(Objective, ChargesARunThatTakesLongToWalk) {
  const Task run{stream::Gait::kRun, 6};
  TrialResult result = AsWanted(run);
  result.latency_s = 1.2;  // 0.6 s + 0.1 s x 6.
  EXPECT_NEAR(CostOf(run, result).latency, 0, 1e-12);
  result.latency_s = 1.1 * 1.2;
  EXPECT_NEAR(CostOf(run, result).latency, 1, 1e-9);
  result.latency_s = 1.43;  // A hop more.
  EXPECT_DOUBLE_EQ(CostOf(run, result).latency, 2);
  result.latency_s = 0.5;  // Sooner is no fault.
  EXPECT_DOUBLE_EQ(CostOf(run, result).latency, 0);
}

TEST(Objective, DoesNotChargeWhatWasNeverSeen) {
  EXPECT_DOUBLE_EQ(CostOf(kWalk, TrialResult{}).total(), 0);
}

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
  EXPECT_EQ(evaluated, 40 * (1 + kDimensions + 4));  // Here, the differences, four lengths.
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
    // 4 + 3 ln n offspring and the mean.
    EXPECT_EQ(evaluated, 5 * (5 + static_cast<int>(3 * std::log(kDimensions))));
    return state.point;
  };
  EXPECT_EQ(after(1), after(1));
  EXPECT_NE(after(1), after(2));
}

TEST(SearchSpace, OfThePapersGaitsHasTheConstantsOfItsEquations) {
  std::set<std::string_view> names;
  for (const Dimension& dimension : DimensionsOf(stream::Gait::kWalk, /*paper=*/true)) {
    names.insert(dimension.gain->name);
  }
  EXPECT_TRUE(names.contains("paper.walk_offset_rad"));
  EXPECT_TRUE(names.contains("paper.walk_gain_rad_per_mps"));
  EXPECT_TRUE(names.contains("paper.touchdown_length_m"));
  EXPECT_FALSE(names.contains("walking.step_width_m"));
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
