#include "common/virtual/motion/signal.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::motion {
namespace {

Eigen::MatrixXd Sine(double frequency_hz, double rate_hz, Eigen::Index frames) {
  Eigen::MatrixXd signal(1, frames);
  for (Eigen::Index i = 0; i < frames; ++i) {
    signal(0, i) = std::sin(2 * kPi * frequency_hz * static_cast<double>(i) / rate_hz);
  }
  return signal;
}

TEST(LowPass, HasMinusThreeDecibelsAtItsCutoffAndNoLag) {
  const Eigen::MatrixXd in = Sine(6, 120, 1201);
  const Eigen::MatrixXd out = LowPass(in, 120, 6);
  const auto middle = Eigen::seqN(300, 600);
  // In phase with the signal, 1/sqrt(2) of it.
  EXPECT_LT((out(0, middle) - in(0, middle) / std::sqrt(2.0)).cwiseAbs().maxCoeff(), 0.01);
}

TEST(LowPass, LeavesSlowSignalsAndTakesFastOnesAway) {
  const Eigen::MatrixXd slow = Sine(0.5, 120, 1201), fast = Sine(40, 120, 1201);
  const auto middle = Eigen::seqN(100, 1000);
  EXPECT_LT((LowPass(slow, 120, 6) - slow)(0, middle).cwiseAbs().maxCoeff(), 0.001);
  EXPECT_LT(LowPass(fast, 120, 6)(0, middle).cwiseAbs().maxCoeff(), 0.001);
}

TEST(LowPass, AStraightLineStaysToItsEnds) {
  const Eigen::MatrixXd line = Eigen::RowVectorXd::LinSpaced(200, -3, 5);
  EXPECT_LT((LowPass(line, 100, 5) - line).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(LowPass, OneOrTwoFramesStayAsTheyAre) {
  const Eigen::MatrixXd two = Eigen::RowVector2d(1, 2);
  EXPECT_EQ(LowPass(two, 100, 5), two);
}

TEST(Spline, MeetsASineAndItsDerivatives) {
  const Spline spline(Sine(1, 100, 401), 100);
  const double w = 2 * kPi;
  for (double t_s : {0.503, 1.25, 2.777, 3.4}) {
    EXPECT_NEAR(spline.Value(t_s)(0), std::sin(w * t_s), 1e-6);
    EXPECT_NEAR(spline.FirstDerivative(t_s)(0), w * std::cos(w * t_s), 1e-3);
    EXPECT_NEAR(spline.SecondDerivative(t_s)(0), -w * w * std::sin(w * t_s), 0.05);
  }
  EXPECT_NEAR(spline.Value(0.31)(0), std::sin(w * 0.31), 1e-6);  // A sample.
  EXPECT_EQ(spline.Value(99)(0), spline.Value(4)(0));
}

TEST(Spline, OneSampleIsAConstant) {
  const Spline spline(Eigen::MatrixXd::Constant(2, 1, 7), 100);
  EXPECT_EQ(spline.Value(3)(1), 7);
  EXPECT_EQ(spline.FirstDerivative(3)(1), 0);
}

}  // namespace
}  // namespace footing::motion
