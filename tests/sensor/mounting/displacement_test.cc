#include "daemon/sensor/mounting/displacement.h"

#include <gtest/gtest.h>

namespace footing::tare {
namespace {

class DisplacementTest : public testing::Test {
 protected:
  /// A second of the same forces at 60 Hz.
  bool Hold(const board::CornerForces& forces, double seconds = 1) {
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
      now_ns_ += 16'666'667;
      displacement_.Advance(now_ns_, forces);
    }
    return displacement_.moved();
  }
  Displacement displacement_;
  std::int64_t now_ns_ = 0;
};

TEST_F(DisplacementTest, AnEmptyBoardIsNotMoved) { EXPECT_FALSE(Hold({0.5, -0.5, 0.3, 0}, 60)); }

TEST_F(DisplacementTest, LiftingItUnloadsItsOwnFeet) {
  EXPECT_FALSE(Hold({0, 0, 0, 0}));
  EXPECT_TRUE(Hold({-7.5, -7.5, -7.5, -7.5}));  // About -3 kg.
  EXPECT_TRUE(Hold({0, 0, 0, 0}, 10)) << "it stays until the layout is checked again";
}

TEST_F(DisplacementTest, TiltingItAtOneEdgeUnloadsTwoFeet) {
  EXPECT_TRUE(Hold({-7.5, -7.5, 0, 0}));
}

TEST_F(DisplacementTest, SomebodyAtItsEdgeDoesNotMoveIt) {
  // Beyond the sensors the far edge rises, under a load of 70 kg.
  EXPECT_FALSE(Hold({400, -20, 350, -25}, 30));
}

TEST_F(DisplacementTest, AJumpThatUnloadsItForAMomentDoesNotMoveIt) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(Hold({200, 200, 200, 200}, 0.5));
    EXPECT_FALSE(Hold({-5, -5, -5, -5}, 0.3));
  }
}

TEST_F(DisplacementTest, AnotherFloorShowsByItsCorners) {
  EXPECT_FALSE(Hold({8, -8, -8, 8}, 1.5));
  EXPECT_TRUE(Hold({8, -8, -8, 8}, 1));
}

TEST_F(DisplacementTest, APauseProvesNothing) {
  EXPECT_FALSE(Hold({0, 0, 0, 0}));
  now_ns_ += 20'000'000'000;
  EXPECT_FALSE(Hold({-7.5, -7.5, -7.5, -7.5}, 0.3));
}

}  // namespace
}  // namespace footing::tare
