#include "daemon/offline/tune/style_terms.h"

#include <gtest/gtest.h>

#include <set>

#include "common/base/units.h"
#include "daemon/offline/tune/team.h"
#include "daemon/offline/tune/trial.h"
#include "daemon/offline/tune/tune_command.h"
#include "daemon/simulation/gait_service/config.h"

namespace footing::tune {
namespace {

using stream::Gait;

constexpr double kSpeedMps = 1.2, kWeightN = 100;

/// A walk on all of the published curves, which slides, jerks and works nothing.
style::GaitStyle OnTheCurves() {
  const style::PelvisReference pelvis = style::SaundersPelvis(kSpeedMps);
  style::GaitStyle style;
  style.steps = 10;
  style.speed_mps = kSpeedMps;
  style.cadence_hz = style::AlexanderCadence(kSpeedMps, style::kHipHeightM);
  style.bob_m = style::OrendurffBob(kSpeedMps);
  style.roll = pelvis.roll;
  style.yaw = pelvis.yaw;
  return style;
}

StyleCost Walked(const style::GaitStyle& style) {
  return StyleCostOf(Gait::kWalk, style, kWeightN, /*steady=*/true);
}

TEST(StyleObjective, IsNothingOnThePublishedCurves) {
  EXPECT_NEAR(Walked(OnTheCurves()).total(), 0, 1e-12);
}

TEST(StyleObjective, ChargesHalfOfEachTermAtWhatIsTolerated) {
  style::GaitStyle style = OnTheCurves();
  style.cadence_hz *= 1.15;
  style.bob_m += 0.01;
  style.roll.amplitude_rad -= DegreesToRadians(2);
  style.yaw.amplitude_rad += DegreesToRadians(2);
  style.slide_max_m = 0.005;
  style.jerk_rms_mps3 = 500;
  style.work_n = 0.5 * kWeightN;
  const StyleCost cost = Walked(style);
  for (const double term :
       {cost.cadence, cost.bob, cost.roll, cost.yaw, cost.slide, cost.jerk, cost.transport}) {
    EXPECT_NEAR(term, 0.5, 1e-9);
  }
}

TEST(StyleObjective, ChargesASwingOfTheRightSizeInTheWrongPhase) {
  style::GaitStyle style = OnTheCurves();
  style.yaw.peak_phase = 1;
  style.bob_low_phase = 0.5;
  EXPECT_GT(Walked(style).yaw, 0.9);
  EXPECT_GT(Walked(style).bob, 0.9);
}

TEST(StyleObjective, OfARunHasNoCurvesForBobAndPelvis) {
  style::GaitStyle style = OnTheCurves();
  style.bob_m = 0.2;
  style.roll = style.yaw = {};
  style.slide_max_m = 0.01;
  const StyleCost cost = StyleCostOf(Gait::kRun, style, kWeightN, /*steady=*/true);
  EXPECT_EQ(cost.bob + cost.roll + cost.yaw, 0);
  EXPECT_NEAR(cost.slide, 0.8, 1e-12);
}

TEST(StyleObjective, OfAChangeOfSpeedLeavesTheCurvesAlone) {
  style::GaitStyle style = OnTheCurves();
  style.cadence_hz *= 2;
  style.jerk_rms_mps3 = 500;
  const StyleCost cost = StyleCostOf(Gait::kWalk, style, kWeightN, /*steady=*/false);
  EXPECT_EQ(cost.cadence, 0);
  EXPECT_NEAR(cost.total(), 0.5, 1e-12);
}

TEST(StyleObjective, ChargesNothingWithoutAWholeStep) {
  EXPECT_EQ(StyleCostOf(Gait::kWalk, {}, kWeightN, true).total(), 0);
}

TEST(StyleObjective, OfAFallIsWorseThanTheWorstStyle) {
  TrialResult worst{.survived = 1, .speed_error_mps = 9};  // A trial that turns measures no style.
  worst.style.steps = 1;
  worst.style.speed_mps = kSpeedMps;
  worst.style.cadence_hz = 99;
  worst.style.bob_m = worst.style.slide_max_m = 9;
  worst.style.roll.amplitude_rad = worst.style.yaw.amplitude_rad = 9;
  worst.style.jerk_rms_mps3 = worst.style.work_n = 1e9;
  const Task walk{.gait = Gait::kWalk, .speed_mps = kSpeedMps, .style = true};
  TrialResult fallen;
  fallen.survived = 0.9999;
  EXPECT_GT(CostOf(walk, worst, kWeightN).total(), 8);
  EXPECT_GT(CostOf(walk, fallen, kWeightN).total(), CostOf(walk, worst, kWeightN).total());
}

TEST(StyleSearch, MovesTheGainsOfTheStyleOnly) {
  for (const Gait gait : {Gait::kWalk, Gait::kRun}) {
    EXPECT_TRUE(HasStyle(gait));
    for (const Dimension& dimension : StyleDimensionsOf(gait)) {
      EXPECT_TRUE(dimension.scale > 0) << dimension.gain->name;
      EXPECT_FALSE(dimension.gain->name.starts_with("fade.")) << dimension.gain->name;
    }
  }
  EXPECT_FALSE(HasStyle(Gait::kStep));
  EXPECT_FALSE(HasStyle(Gait::kJump));
}

TEST(StyleSearch, DrawsEachKindOfTrial) {
  const Task walk{.gait = Gait::kWalk, .speed_mps = kSpeedMps, .style = true};
  int pushed = 0, pits = 0, turning = 0, changing = 0, measured = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Disturbance drawn = Draw(walk, seed);
    pushed += drawn.kick_ns > 10 ? 1 : 0;
    pits += drawn.pit_m > 0 ? 1 : 0;
    turning += drawn.turn_rad != 0 ? 1 : 0;
    changing += drawn.change_s > 0 ? 1 : 0;
    measured += drawn.trial_s > kTrialS ? 1 : 0;
    EXPECT_EQ(drawn.change_s > 0, drawn.change.gait == Gait::kWalk);
  }
  EXPECT_EQ(pushed + pits + turning + changing + measured, 200);
  EXPECT_NEAR(pushed, 60, 25);
  EXPECT_NEAR(measured, 80, 25);
  for (const int rare : {pits, turning, changing}) EXPECT_NEAR(rare, 20, 15);
}

/// The bob that is asked for is in what a styled team charges, and not in the plain gait's.
TEST(StyleSearch, MeasuresTheGainsThatAreTried) {
  auto team = Team::Create(1, {}, {}, /*styled=*/true);
  ASSERT_TRUE(team.ok());
  const gait::GainTable table = *TableOf(engine_files::ReadTexts()->style, {});
  const Task walk{.gait = Gait::kWalk, .speed_mps = kSpeedMps, .style = true};
  ASSERT_TRUE(team->Prepare({walk}, table, 3).ok());
  std::vector<gait::Gains> gains(2, table.At(Gait::kWalk, kSpeedMps));
  gains[1].style.bob_share = 0;
  std::uint64_t seed = 1;  // Its first trial goes straight on.
  while (Draw(walk, MixSeeds(seed, 0)).trial_s == kTrialS) ++seed;
  const auto costs = team->Try(gains, 1, seed);
  EXPECT_EQ(costs[0][0].failure, 0);
  EXPECT_LT(costs[0][0].style.bob, 0.6);
  EXPECT_GT(costs[1][0].style.bob, 0.8);
  EXPECT_LT(costs[0][0].style.cadence, 0.5);
}

}  // namespace
}  // namespace footing::tune
