#include <gtest/gtest.h>

#include <cmath>

#include "daemon/simulation/momentum/best_estimator.h"
#include "daemon/simulation/momentum/load_share.h"
#include "tests/simulation/momentum/made_body.h"

// People who are not where their boards measure them.
namespace footing::momentum {
namespace {

constexpr double kBodyN = kMadeMassKg * kStandardGravityMps2;

/// A board whose cells, in the order of board::Corners, carry these loads.
FootLoads Board(const std::array<double, 4>& loads_n) {
  FootLoads foot = MadeBody().At(0).feet[0];
  for (std::size_t i = 0; i < 4; ++i) foot.cells[i].load_n = loads_n[i];
  return foot;
}

TEST(AtEdge, IsWhereOneSideCarriesAll) {
  EXPECT_FALSE(AtEdge(Board({100, 100, 100, 100})));
  EXPECT_TRUE(AtEdge(Board({200, 200, 1, 2})));
  EXPECT_TRUE(AtEdge(Board({0, 1, 200, 200})));
  EXPECT_TRUE(AtEdge(Board({200, 0, 200, 0})));
  EXPECT_TRUE(AtEdge(Board({0, 200, 0, 200})));
  EXPECT_FALSE(AtEdge(Board({10, 10, 0, 0}))) << "too little load for a place";
  EXPECT_FALSE(AtEdge(Board({300, 300, -100, -100}))) << "a plate without an edge";
}

TEST(TPoseCalibration, RefusesAFootAtTheEdgeOfItsBoard) {
  TPoseCalibration calibration;
  for (int i = 0; i < 400; ++i) {
    ContactLoads loads = MadeBody().At(i * kMadeStepS);
    loads.feet[1] = Board({0, 0, 0.25 * kBodyN, 0.25 * kBodyN});
    ASSERT_FALSE(calibration.Advance(loads, kMadeStepS));
  }
  EXPECT_EQ(calibration.progress(), 0);
}

TEST(LoadShare, StaysWholeInHops) {
  LoadShare share;
  // Twice the weight for 0.35 s, then 0.35 s in the air.
  for (int i = 0; i < 1200; ++i) {
    share.Advance(std::fmod(i * kMadeStepS, 0.7) < 0.35 ? 2 : 0, kMadeStepS);
    ASSERT_TRUE(share.whole()) << i;
  }
}

TEST(LoadShare, IsNotWholeBesideABoardAndSoonIsAgain) {
  LoadShare share;
  int until = 0;
  while (share.whole()) {
    share.Advance(0.5, kMadeStepS);
    ASSERT_LT(++until * kMadeStepS, 1.5);
  }
  for (int i = 0; i < 120; ++i) share.Advance(0.5, kMadeStepS);
  until = 0;
  while (!share.whole()) {
    share.Advance(1, kMadeStepS);
    ASSERT_LT(++until * kMadeStepS, 1.5);
  }
}

TEST(BestEstimator, DoesNotTrustLoadsWhileAFootStandsBesideItsBoard) {
  MadeBody body;
  BestEstimator best({}, {}, body.Calibrate(), kMadeStepS);
  const auto stand = [&](double seconds, bool left_on_floor) {
    for (int i = 0; i < seconds / kMadeStepS; ++i) {
      ContactLoads loads = body.At(0);
      if (left_on_floor) loads.feet[0] = Board({0, 0, 0, 0});
      best.Advance(loads);
      best.SeePosture(0, {0, 0, kMadeHeightM});
    }
  };
  stand(2, false);
  EXPECT_TRUE(best.estimate().whole_weight);
  stand(2, true);
  for (int i = 0; i < 20; ++i) {
    stand(0.5, true);
    EXPECT_FALSE(best.estimate().whole_weight) << i;
    EXPECT_FALSE(best.estimate().trusted) << i;
    EXPECT_NEAR(best.estimate().load_share, 0.5, 0.05);
  }
  stand(2, false);
  EXPECT_TRUE(best.estimate().whole_weight);
  EXPECT_NEAR(best.estimate().p_WC_m.y(), 0, 0.03);
}

}  // namespace
}  // namespace footing::momentum
