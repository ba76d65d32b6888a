#include "daemon/simulation/momentum/horizontal_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace footing::momentum {
namespace {

constexpr double kMassKg = 75;
constexpr double kWeightN = kMassKg * 9.80665;

/// c(t+1) = gain c(t) + (1 - gain) share of F(t), for one axis: as linear networks are.
cascade::CascadeNetwork Linear(double c2, double c1, double c0, double other,
                               const std::array<double, kNetworkCells>& now) {
  cascade::NetworkWeights weights;
  weights.inputs = kNetworkInputs;
  weights.outputs = 1;
  weights.input_mean.assign(kNetworkInputs, 0);
  weights.input_scale.assign(kNetworkInputs, 1);
  weights.output_weights.assign(1 + kNetworkInputs, 0);
  for (std::size_t i = 0; i < kNetworkCells; ++i)
    weights.output_weights[1 + kNetworkCells + i] = static_cast<float>(now[i]);
  const std::array past{c2, c1, c0, other};
  for (std::size_t i = 0; i < past.size(); ++i)
    weights.output_weights[1 + 2 * kNetworkCells + i] = static_cast<float>(past[i]);
  weights.output_mean = {0};
  weights.output_scale = {1};
  return cascade::CascadeNetwork::Create(std::move(weights), "made").value();
}

/// Follows the moment of the cells (which is the COP under the standing weight) with one pole.
HorizontalLoop::Networks Following(double pole) {
  std::array<double, kNetworkCells> x{}, y{};
  const auto cells = NetworkCells();
  for (std::size_t i = 0; i < kNetworkCells; ++i) {
    x[i] = (1 - pole) * cells[i].x();
    y[i] = (1 - pole) * cells[i].y();
  }
  return {Linear(0, 0, pole, 0, x), Linear(0, 0, pole, 0, y)};
}

ContactLoads Standing(const Eigen::Vector2d& left_m, const Eigen::Vector2d& right_m) {
  ContactLoads loads;
  const std::array places{left_m, right_m};
  for (std::size_t f = 0; f < kFeet; ++f) {
    loads.feet[f].valid = true;
    loads.feet[f].count = 1;
    loads.feet[f].cells[0] = {{places[f].x(), places[f].y(), 0}, kWeightN / 2};
  }
  return loads;
}

TPose Pose(const Eigen::Vector2d& left_m, const Eigen::Vector2d& right_m) {
  TPose pose;
  pose.mass_kg = kMassKg;
  pose.load_n = {kWeightN / 2, kWeightN / 2};
  pose.p_WP_m = {Eigen::Vector3d(left_m.x(), left_m.y(), 0),
                 Eigen::Vector3d(right_m.x(), right_m.y(), 0)};
  pose.cop_m = 0.5 * (pose.p_WP_m[0] + pose.p_WP_m[1]);
  return pose;
}

TEST(NetworkLoads, HaveTheSumAndTheMomentOfAnyCells) {
  ContactLoads loads;
  loads.feet[0].valid = loads.feet[1].valid = true;
  loads.feet[0].count = 3;
  loads.feet[0].cells[0] = {{0.6, 1.2, 0}, 100};
  loads.feet[0].cells[1] = {{0.4, 1.1, 0}, 250};
  loads.feet[0].cells[2] = {{0.5, 1.3, 0}, 50};
  loads.feet[1].count = 1;
  loads.feet[1].cells[0] = {{0.45, 0.9, 0}, 300};
  const Eigen::Vector2d origin(0.5, 1);
  const NetworkLoads out = ToNetworkLoads(loads, origin, 1);
  EXPECT_NEAR(std::accumulate(out.begin(), out.begin() + 4, 0.0), 400, 1e-9);
  EXPECT_NEAR(std::accumulate(out.begin() + 4, out.end(), 0.0), 300, 1e-9);
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  const auto cells = NetworkCells();
  for (std::size_t i = 0; i < out.size(); ++i) moment += out[i] * cells[i];
  // Sum of load times place from the origin: x 10 - 25 + 0 - 15, y 20 + 25 + 15 - 30.
  EXPECT_NEAR(moment.x(), -30, 1e-9);
  EXPECT_NEAR(moment.y(), 30, 1e-9);
}

TEST(HorizontalLoop, TakesItsOwnOutputsAsThePapersInputs) {
  const NetworkLoads before{1, 2, 3, 4, 5, 6, 7, 8}, now{11, 12, 13, 14, 15, 16, 17, 18};
  const std::array<Eigen::Vector2d, 3> com{Eigen::Vector2d(21, 31), Eigen::Vector2d(22, 32),
                                           Eigen::Vector2d(23, 33)};
  const auto y = NetworkInputs(before, now, com, 1);
  const std::array<double, kNetworkInputs> expected{1,  2,  3,  4,  5,  6,  7,  8,  11, 12,
                                                    13, 14, 15, 16, 17, 18, 31, 32, 33, 23};
  EXPECT_EQ(y, expected);

  const HorizontalLoop::Networks networks{Linear(1, 0, 0, 0, {}), Linear(0, 0, 0, 1, {})};
  HorizontalLoop loop(networks, {}, {Eigen::Vector2d(.1, .4), {.2, .5}, {.3, .6}});
  EXPECT_TRUE(loop.Step({}).isApprox(Eigen::Vector2d(.1, .3), 1e-6));  // c_x(t-2), c_x(t)
  EXPECT_TRUE(loop.Step({}).isApprox(Eigen::Vector2d(.2, .1), 1e-6));
}

TEST(HorizontalNetwork, BeginsAtTheTPoseAndStaysThere) {
  const Eigen::Vector2d left(2.03, -0.8), right(1.97, -1.2);
  const auto networks = Following(0.9);
  for (const double rate_hz : {30.0, 60.0, 100.0, 120.0}) {
    HorizontalNetwork network(networks, Pose(left, right), 1 / rate_hz);
    for (int i = 0; i < 300; ++i) {
      EXPECT_TRUE(network.Advance(Standing(left, right)).isApprox(Eigen::Vector2d(2, -1), 1e-5));
    }
  }
}

TEST(HorizontalNetwork, StepsAtTheTrainingRateWhateverTheFrames) {
  // A step of 0.1 m, followed with a pole of 0.95 a sixtieth: after half a second 0.95^30 = 0.215
  // of it is left; a frame more or less is 5 % of that.
  const Eigen::Vector2d left(0, 0.2), right(0, -0.2), by(0.1, 0);
  const auto networks = Following(0.95);
  for (const double rate_hz : {30.0, 60.0, 100.0, 120.0}) {
    HorizontalNetwork network(networks, Pose(left, right), 1 / rate_hz);
    double x = 0;
    for (int i = 0; i < std::lround(0.5 * rate_hz); ++i)
      x = network.Advance(Standing(left + by, right + by)).x();
    EXPECT_NEAR(0.1 - x, 0.0215, 0.0025) << rate_hz;
  }
}

TEST(HorizontalNetwork, IsBoundedAndFiniteWhateverTheNetworksAndLoadsDo) {
  const auto runaway = Linear(0, 0, 1.5, 0.3, {1, 1, 1, 1, 1, 1, 1, 1});
  const HorizontalLoop::Networks networks{runaway, runaway};
  const Eigen::Vector2d left(0, 0.2), right(0, -0.2);
  HorizontalNetwork network(networks, Pose(left, right), 1.0 / 60);
  for (int i = 0; i < 600; ++i) {
    ContactLoads loads = Standing(left, right);
    if (i % 7 == 0) loads.feet[0].cells[0].load_n = std::numeric_limits<double>::quiet_NaN();
    if (i % 11 == 0) loads.feet[1].cells[0].load_n = 1e300;
    if (i % 13 == 0) loads.feet[1].valid = false;
    const Eigen::Vector2d& c = network.Advance(loads);
    ASSERT_TRUE(c.allFinite()) << i;
    ASSERT_LE(c.cwiseAbs().maxCoeff(), HorizontalLoop::kBorderM + 1e-9) << i;
  }
}

TEST(HorizontalNetwork, HoldsWhileASourceIsLost) {
  const Eigen::Vector2d left(0, 0.2), right(0, -0.2);
  const auto networks = Following(0.5);
  HorizontalNetwork network(networks, Pose(left, right), 1.0 / 60);
  ContactLoads lost = Standing(left + Eigen::Vector2d(0.3, 0), right);
  lost.feet[1].valid = false;
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(network.Advance(lost).x(), 0, 1e-6);
}

}  // namespace
}  // namespace footing::momentum
