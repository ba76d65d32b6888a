#include "common/base/low_pass.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing {
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

}  // namespace
}  // namespace footing
