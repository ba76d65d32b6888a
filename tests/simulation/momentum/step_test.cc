#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/step_watch.h"
#include "tests/simulation/momentum/made_body.h"

// People who step ahead, or lunge.
namespace footing::momentum {
namespace {

/// The made body's loads with the left foot `ahead_m` further ahead and `left_share` of the weight
/// on it.
ContactLoads Lunge(MadeBody& body, double ahead_m, double left_share) {
  constexpr double kWeightN = kMadeMassKg * kStandardGravityMps2;
  ContactLoads loads = body.At(0);
  for (std::size_t f = 0; f < kFeet; ++f) {
    const double share = f == 0 ? left_share : 1 - left_share;
    const double cop_m = f == 0 ? ahead_m : 0;
    for (Cell& cell : loads.feet[f].cells) {
      cell.load_n =
          0.25 * kWeightN * share * (1 + cop_m * cell.p_WS_m.x() / std::pow(kHalfLengthM, 2));
    }
  }
  return loads;
}

TEST(StepWatch, SeesAFootThatStandsElsewhereUntilItHasStoodThere) {
  StepWatch watch;
  watch.Start({0, 0});
  const auto stand = [&](double left_m, double seconds) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) watch.Advance({left_m, 0}, kMadeStepS);
  };
  stand(0.18, 15);  // As far as a foot can stand on its board.
  EXPECT_FALSE(watch.stepped());
  stand(0.18 + 0.35, 0.02);
  EXPECT_TRUE(watch.stepped());
  stand(0.18 + 0.35, 3 * std::log(0.35 / 0.2) - 0.1);
  EXPECT_TRUE(watch.stepped());
  stand(0.18 + 0.35, 0.2);
  EXPECT_FALSE(watch.stepped());
  stand(0.18 + 0.35, 10);
  stand(0.18, 0.02);  // Back again.
  EXPECT_TRUE(watch.stepped());
}

TEST(BestEstimator, ReportsAStepAndDoubtsWhereTheBodyIs) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  const auto move = [&](double ahead_m, double left_share, double seconds) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) best.Advance(Lunge(body, ahead_m, left_share));
  };
  move(0, 0.5, 2);
  move(0, 0, 0.4);  // A knee is raised, and the foot comes down where it was.
  move(0, 0.5, 0.4);
  EXPECT_FALSE(best.estimate().stepped);
  EXPECT_LT(std::sqrt(best.estimate().position_variance_m2.x()), 0.05);
  move(0, 0, 0.4);
  EXPECT_FALSE(best.estimate().stepped);
  move(0.4, 0.5, 0.2);
  EXPECT_TRUE(best.estimate().stepped);
  EXPECT_TRUE(best.estimate().trusted) << "the height is what it was";
  EXPECT_GT(std::sqrt(best.estimate().position_variance_m2.x()), 0.1);
  move(0.4, 0.5, 4);
  EXPECT_FALSE(best.estimate().stepped);
  EXPECT_LT(std::sqrt(best.estimate().position_variance_m2.x()), 0.05);
}

}  // namespace
}  // namespace footing::momentum
