#include "daemon/offline/learning/quickprop.h"

#include <gtest/gtest.h>

namespace footing::learning {
namespace {

Eigen::MatrixXd One(double value) { return Eigen::MatrixXd::Constant(1, 1, value); }

TEST(Quickprop, JumpsToTheLowestPointOfAParabola) {
  // GIVEN f = 2 (w - 3)^2, slope 4 (w - 3), and a first step by the slope alone.
  Quickprop quickprop(1, 1, {.epsilon = 0.4, .growth = 2, .decay = 0});
  Eigen::MatrixXd w = One(0);
  quickprop.Step(One(4 * (0 - 3.0)), w);
  EXPECT_DOUBLE_EQ(w(0), 4.8);  // 0.4 * 12: beyond the lowest point.
  // WHEN the slope has changed its sign, THEN the parabola through both slopes is followed alone.
  quickprop.Step(One(4 * (4.8 - 3)), w);
  EXPECT_NEAR(w(0), 3, 1e-12);
}

TEST(Quickprop, GrowsAStepByAtMostItsFactor) {
  Quickprop quickprop(1, 1, {.epsilon = 1, .growth = 1.75, .decay = 0});
  Eigen::MatrixXd w = One(0);
  quickprop.Step(One(-1), w);
  EXPECT_DOUBLE_EQ(w(0), 1);
  quickprop.Step(One(-0.99), w);  // Nearly as steep: the parabola's lowest point is 99 away.
  EXPECT_DOUBLE_EQ(w(0), 1 + 0.99 + 1.75 * 1);
}

TEST(Quickprop, StaysFiniteOnEqualSlopesAndOnNone) {
  Quickprop quickprop(1, 1, {.epsilon = 1, .growth = 2, .decay = 0});
  Eigen::MatrixXd w = One(1);
  for (const double slope : {1.0, 1.0, 1.0, 0.0, 0.0, -1.0, -1.0, 1e-300, 1e-300}) {
    quickprop.Step(One(slope), w);
    ASSERT_TRUE(std::isfinite(w(0)));
  }
}

TEST(Quickprop, DecayPullsAWeightToZero) {
  Quickprop quickprop(1, 1, {.epsilon = 0.1, .growth = 2, .decay = 0.5});
  Eigen::MatrixXd w = One(8);
  quickprop.Step(One(0), w);
  EXPECT_DOUBLE_EQ(w(0), 8 - 0.1 * 0.5 * 8);
}

}  // namespace
}  // namespace footing::learning
