#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <vector>

#include "common/virtual/devices/noise.h"
#include "daemon/simulation/momentum/contact_loads.h"
#include "daemon/simulation/momentum/horizontal_com.h"
#include "daemon/simulation/momentum/linear_filter.h"
#include "tests/simulation/momentum/made_body.h"

namespace footing::momentum {
namespace {

TEST(LinearFilter, FindsTheMeanOfAConstantWithOneOverNOfTheVariance) {
  LinearFilter<1, 1> filter;
  using F = LinearFilter<1, 1>;
  filter.Start(F::Vector(0), F::Matrix(1e6));
  for (const double z : {1.0, 2.0, 3.0, 6.0}) filter.Update(F::Row(1), z, 4);
  EXPECT_NEAR(filter.x()(0), 3, 1e-4);     // (1 + 2 + 3 + 6) / 4
  EXPECT_NEAR(filter.p()(0, 0), 1, 1e-4);  // 4 / 4
}

TEST(LinearFilter, DelayedScalarIsThatOfTheBackwardRecursion) {
  // A random walk of variance 1 seen with variance 1 at steps 0, 1, 2: by hand, the smoothed mean
  // of step 0 is the least-squares solution of the chain.
  using F = LinearFilter<1, 4>;
  F filter;
  filter.Start(F::Vector(0), F::Matrix(1e9));
  const double z[3] = {1, 2, 4};
  for (int i = 0; i < 3; ++i) {
    if (i > 0) filter.Predict(F::Matrix(1), F::Vector(0), F::Matrix(1));
    filter.Update(F::Row(1), z[i], 1);
    filter.Remember(F::Row(1));
  }
  Eigen::Matrix3d information;
  information << 2, -1, 0, -1, 3, -1, 0, -1, 2;
  const Eigen::Vector3d mean = information.inverse() * Eigen::Vector3d(1, 2, 4);
  EXPECT_NEAR(filter.Delayed(2).mean, mean(0), 1e-6);
  EXPECT_NEAR(filter.Delayed(1).mean, mean(1), 1e-6);
  EXPECT_NEAR(filter.Delayed(2).variance, information.inverse()(0, 0), 1e-6);
}

TEST(LinearFilter, KeepsNoMoreStepsThanItIsTold) {
  using F = LinearFilter<1, 4>;
  F filter;
  filter.Keep(2);
  filter.Start(F::Vector(0), F::Matrix(1));
  for (const double z : {1.0, 2.0, 4.0}) {
    filter.Predict(F::Matrix(1), F::Vector(0), F::Matrix(1));
    filter.Update(F::Row(1), z, 1);
    filter.Remember(F::Row(1));
  }
  EXPECT_EQ(filter.Delayed(3).mean, filter.Delayed(1).mean);
  EXPECT_LT(filter.Delayed(1).mean, filter.Delayed(0).mean);
}

TEST(Mixture, FarFromTheFirstComponentTheSecondTakesAll) {
  const auto out = TimesMixture({-0.5, 0.01}, {{{0.9, 0, 0.02}, {0.1, -0.5, 0.1}}});
  EXPECT_NEAR(out.moments.mean, -0.5, 1e-3);
  EXPECT_NEAR(out.moments.variance, 0.005, 1e-4);  // 0.01 times 0.01 over their sum.
}

TEST(Mixture, CutsOffAboveTheLimit) {
  // Half a normal density: mean -sqrt(2 / pi), variance 1 - 2 / pi.
  const Moments half = Below({0, 1}, 0);
  EXPECT_NEAR(half.mean, -std::sqrt(2 / kPi), 1e-9);
  EXPECT_NEAR(half.variance, 1 - 2 / kPi, 1e-9);
  for (const double a : {-5.0, -50.0, -1e6}) {
    const Moments tail = Below({0, 1}, a);
    EXPECT_LT(tail.mean, a);
    EXPECT_GT(tail.variance, 0);
    EXPECT_TRUE(std::isfinite(tail.mean));
  }
}

HorizontalPrior Prior() {
  HorizontalPrior prior;
  prior.moment_spread_m = 0.003;
  return prior;
}

TEST(HorizontalCom, SmootherFindsASwayThatTheCopOvershoots) {
  // Given a point mass that sways by 5 cm at 0.7 Hz: the COP overshoots it by w^2 z / g = 2.
  const double w = 2 * kPi * 0.7;
  std::vector<HorizontalInput> inputs;
  std::vector<double> truth;
  noise::Random random(3);
  for (int i = 0; i < 1200; ++i) {
    const double t = i * kMadeStepS;
    truth.push_back(0.05 * std::sin(w * t));
    HorizontalInput input;
    input.load_n = kMadeMassKg * kStandardGravityMps2;
    input.cop_valid = true;
    input.cop_m = truth.back() * (1 + w * w / kStandardGravityMps2) + 0.001 * random.Normal();
    inputs.push_back(input);
  }
  const auto smooth = SmoothHorizontal(Prior(), kMadeMassKg, kMadeStepS, 0, inputs);
  HorizontalCom causal(Prior(), {}, kMadeMassKg, kMadeStepS);
  causal.Start(0, 0);
  double offline = 0, now = 0, late = 0, cop = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    causal.Advance(inputs[i]);
    if (i < 300 || i >= 1100) continue;
    offline += std::pow(smooth[i].mean - truth[i], 2);
    cop += std::pow(inputs[i].cop_m - truth[i], 2);
    now += std::pow(causal.Position(0).mean - truth[i], 2);
    late += std::pow(causal.Position(12).mean - truth[i - 12], 2);
  }
  EXPECT_LT(std::sqrt(offline / 800), 0.004);
  EXPECT_LT(late, now);
  EXPECT_LT(now, cop);
  EXPECT_GT(std::sqrt(cop / 800), 0.06);
}

TEST(FootContact, SeesALandingInItsFirstFrameAndForgetsAnOffset) {
  FootContact contact;
  for (int i = 0; i < 600; ++i) EXPECT_FALSE(contact.Advance(6, kMadeStepS));
  EXPECT_NEAR(contact.tare_n(), 6, 0.2);
  EXPECT_TRUE(contact.Advance(6 + 21, kMadeStepS));
  EXPECT_TRUE(contact.Advance(6 + 14, kMadeStepS));  // Hysteresis.
  EXPECT_FALSE(contact.Advance(6 + 11, kMadeStepS));
}

}  // namespace
}  // namespace footing::momentum
