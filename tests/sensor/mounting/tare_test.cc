#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/virtual/devices/noise.h"
#include "daemon/sensor/mounting/tare.h"

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

/// 2 s at 80 samples a second of a board that carries `total_n(t)`, spread unevenly, with noise.
template <typename Load>
std::vector<TareSample> Samples(Load total_n, double rate_hz = 80) {
  noise::Random random(7);
  std::vector<TareSample> samples;
  for (int i = 0; i < static_cast<int>(2 * rate_hz); ++i) {
    const double t_s = i / rate_hz;
    const double load_n = total_n(t_s);
    const auto noise = [&random] { return 0.5 * random.Normal(); };
    samples.push_back({static_cast<std::int64_t>(t_s * 1e9),
                       {0.4 * load_n + noise(), 0.3 * load_n + noise(), 0.2 * load_n + noise(),
                        0.1 * load_n + noise()}});
  }
  return samples;
}

TEST(Tare, IsTheMeanOfTheCornersAndMayBeNegative) {
  const Tare tare = SolveTare(Samples([](double) { return -12.0; }), 2);
  ASSERT_TRUE(tare.ok) << tare.problem;
  // 160 samples with a noise of 0.5 N: the mean is within 4 standard errors.
  EXPECT_NEAR(tare.offset.top_left_n, 0.4 * -12, 4 * 0.5 / std::sqrt(160));
  EXPECT_NEAR(tare.offset.bottom_right_n, 0.1 * -12, 4 * 0.5 / std::sqrt(160));
  EXPECT_NEAR(tare.residual_n, 1.0, 0.2);  // Four corners: 0.5 sqrt(4).
}

TEST(Tare, RefusesSomebodyWhoStepsOn) {
  const Tare tare = SolveTare(Samples([](double t_s) { return t_s < 1.9 ? 0.0 : 300.0; }), 2);
  EXPECT_FALSE(tare.ok);
  EXPECT_NE(tare.problem.find("moves"), std::string::npos) << tare.problem;
}

TEST(Tare, RefusesASlowDrift) {
  const Tare tare = SolveTare(Samples([](double t_s) { return 4 * t_s; }), 2);
  EXPECT_FALSE(tare.ok);
  EXPECT_NE(tare.problem.find("drifts"), std::string::npos) << tare.problem;
}

TEST(Tare, RefusesALoadThatIsTooHeavyForAnEmptyBoard) {
  EXPECT_TRUE(SolveTare(Samples([](double) { return 90.0; }), 2).ok);
  const Tare tare = SolveTare(Samples([](double) { return 110.0; }), 2);
  EXPECT_FALSE(tare.ok);
  EXPECT_NE(tare.problem.find("step off"), std::string::npos) << tare.problem;
}

TEST(Tare, RefusesTooFewSamplesAndGaps) {
  EXPECT_FALSE(SolveTare({}, 2).ok);
  EXPECT_FALSE(SolveTare(Samples([](double) { return 0.0; }, 10), 2).ok);
  auto samples = Samples([](double) { return 0.0; });
  samples.erase(samples.begin() + 40, samples.begin() + 70);
  EXPECT_NE(SolveTare(samples, 2).problem.find("gap"), std::string::npos);
}

TEST(Tare, ForcesBelowZeroAfterItAreKept) {
  EXPECT_EQ(Total(board::CornerForces{1, 1, 1, 1} - board::CornerForces{2, 2, 2, 2}), -4);
}

}  // namespace
}  // namespace footing::tare
