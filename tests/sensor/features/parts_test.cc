#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "daemon/sensor/features/cadence.h"
#include "daemon/sensor/features/cycle.h"
#include "daemon/sensor/features/sample_grid.h"

/// The parts that the features are made of.
namespace footing::features {
namespace {

void Add(SampleGrid& grid, double t_s, const Eigen::Vector3d& force, bool repeated = false) {
  stream::MotionSample sample;
  sample.sampled_ns = static_cast<std::int64_t>(std::llround(t_s * 1e9));
  sample.specific_force_mps2 = sample.filtered_mps2 = force;
  sample.repeated = repeated;
  grid.Add(sample);
}

TEST(SampleGrid, PointsLieOnTheLineBetweenSamples) {
  SampleGrid grid{Config{}};
  Add(grid, 0.003, {0, 0, 0});
  Add(grid, 0.043, {4, 0, 0});
  ASSERT_EQ(grid.size(), 4);
  // Points at 10, 20, 30, 40 ms: (t - 3 ms) / 40 ms * 4.
  EXPECT_NEAR(grid.Raw(4)(0, 0), 0.7, 1e-12);
  EXPECT_NEAR(grid.Raw(4)(3, 0), 3.7, 1e-12);
}

TEST(SampleGrid, KeepsItsNewestPointsForEver) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 5000; ++i) Add(grid, 0.01 * i, {static_cast<double>(i), 0, 0});
  ASSERT_EQ(grid.size(), kGridLength);
  EXPECT_NEAR(grid.Raw(kGridLength)(0, 0), 5000 - kGridLength, 1e-6);
  EXPECT_NEAR(grid.Raw(1)(0, 0), 4999, 1e-6);
}

TEST(SampleGrid, ForgetsAcrossAPause) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 50; ++i) Add(grid, 0.01 * i, {1, 0, 0});
  Add(grid, 1.0, {2, 0, 0});
  EXPECT_EQ(grid.size(), 1);
}

TEST(CycleWeights, AddUpToTheCycleAndIntegrateALine) {
  for (const double steps : {22.0, 22.2, 57.9, 1.5}) {
    const Eigen::ArrayXd weights = CycleWeights(steps);
    EXPECT_NEAR(weights.sum(), steps, 1e-12);
    // The line y = x from -steps to 0: its integral is -steps² / 2.
    const auto count = weights.size();
    const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(count, 1.0 - count, 0.0);
    EXPECT_NEAR((weights * x).sum(), -0.5 * steps * steps, 1e-9);
  }
}

TEST(FindPeriod, IsSharperThanATwentiethOfAGridStep) {
  SampleGrid grid{Config{}};
  constexpr double kPeriodS = 0.4637;
  for (int i = 0; i < 300; ++i) {
    Add(grid, 0.01 * i, {0, 5 * std::sin(2 * kPi * 0.01 * i / kPeriodS), -9.81});
  }
  const auto estimate = FindPeriod(grid, grid.size(), 0, CadenceConfig{});
  ASSERT_TRUE(estimate.found);
  EXPECT_NEAR(estimate.period_s, kPeriodS, kGridStepS / 20);
}

TEST(FindPeriod, FindsNoneInALine) {
  SampleGrid grid{Config{}};
  for (int i = 0; i < 300; ++i) Add(grid, 0.01 * i, {0, 0.02 * i, -9.81});
  EXPECT_FALSE(FindPeriod(grid, grid.size(), 0, CadenceConfig{}).found);
}

TEST(Cadence, AJumpMustPersistForAQuarterOfTheOldPeriod) {
  const CadenceConfig config;
  Cadence cadence = Next({}, {true, 1.0, 1}, {}, 0.01, config);
  for (int i = 0; i < 25; ++i) {
    cadence = Next(cadence, {true, 0.5, 1}, {}, 0.01, config);
    EXPECT_EQ(cadence.period_s, 1.0) << i;
  }
  for (int i = 0; i < 2; ++i) cadence = Next(cadence, {true, 0.5, 1}, {}, 0.01, config);
  EXPECT_EQ(cadence.period_s, 0.5);
}

TEST(Cadence, AJumpOfOneHandAloneIsNotOne) {
  const CadenceConfig config;
  const Partner partner{{true, 1.0, 1}, 1.0};
  Cadence cadence = Next({}, {true, 1.0, 1}, partner, 0.01, config);
  for (int i = 0; i < 190; ++i) cadence = Next(cadence, {true, 0.5, 1}, partner, 0.01, config);
  EXPECT_EQ(cadence.period_s, 1.0);
  for (int i = 0; i < 20; ++i) cadence = Next(cadence, {true, 0.5, 1}, partner, 0.01, config);
  EXPECT_EQ(cadence.period_s, 0.5);  // Two cycles later it is.
}

TEST(Cadence, OfTwoPeriodsThatSpanSeveralOfTheOtherHandsAJumpToThatIsOneAtOnce) {
  const CadenceConfig config;
  const Partner none, partner{{}, 1.0};  // Its newest samples show nothing for a moment.
  const Cadence two = Next({}, {true, 2.0, 1}, none, 0.01, config);
  EXPECT_TRUE(SpansSeveral(two, partner, config));
  EXPECT_FALSE(SpansSeveral(two, none, config));
  EXPECT_EQ(Next(two, {true, 1.02, 1}, partner, 0.01, config).period_s, 1.02);
  // Another one than the other hand's has to persist, and so has a longer one.
  EXPECT_EQ(Next(two, {true, 0.5, 1}, partner, 0.01, config).period_s, 2.0);
  const Cadence one = Next({}, {true, 1.0, 1}, none, 0.01, config);
  EXPECT_FALSE(SpansSeveral(one, {{}, 2.0}, config));
  EXPECT_EQ(Next(one, {true, 2.0, 1}, {{}, 2.0}, 0.01, config).period_s, 1.0);
}

TEST(Cadence, ALossIsBridgedForOneCycle) {
  const CadenceConfig config;
  Cadence cadence = Next({}, {true, 0.5, 1}, {}, 0.01, config);
  for (int i = 0; i < 49; ++i) cadence = Next(cadence, {}, {}, 0.01, config);
  EXPECT_TRUE(cadence.valid);
  for (int i = 0; i < 2; ++i) cadence = Next(cadence, {}, {}, 0.01, config);
  EXPECT_FALSE(cadence.valid);
}

TEST(Inclination, BeyondOneGIsARightAngleNotNan) {
  EXPECT_EQ(InclinationOf({12, -12, 0}).roll_rad, kPi / 2);
  EXPECT_EQ(InclinationOf({12, -12, 0}).pitch_rad, -kPi / 2);
}

}  // namespace
}  // namespace footing::features
