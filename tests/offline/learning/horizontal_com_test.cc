#include "daemon/offline/learning/horizontal_com.h"

#include <gtest/gtest.h>

#include <numeric>

#include "daemon/offline/learning/cascade.h"

namespace footing::learning {
namespace {

LoadClip HorizontalComNumbered(int frames) {
  LoadClip clip(static_cast<std::size_t>(frames));
  for (int t = 0; t < frames; ++t) {
    auto& frame = clip[static_cast<std::size_t>(t)];
    for (std::size_t k = 0; k < momentum::kNetworkCells; ++k)
      frame.load[k] = 100 * t + static_cast<int>(k);
    frame.c_W_m = {1000 + t, -1000 - t};
  }
  return clip;
}

TEST(HorizontalExamples, AreThePapersInputsAndOutputOfEachAxis) {
  const std::vector<LoadClip> clips = {HorizontalComNumbered(5), HorizontalComNumbered(3),
                                       HorizontalComNumbered(4)};
  const Examples x = HorizontalExamples(clips, 0), y = HorizontalExamples(clips, 1);
  ASSERT_EQ(x.rows(), 2 + 0 + 1);  // No row reaches from one clip into the next.
  ASSERT_EQ(x.inputs.cols(), 20);
  // Second row: t = 3.
  EXPECT_EQ(x.inputs(1, 0), 200);  // F(t-1), first cell
  EXPECT_EQ(x.inputs(1, 7), 207);
  EXPECT_EQ(x.inputs(1, 8), 300);    // F(t)
  EXPECT_EQ(x.inputs(1, 16), 1001);  // c(t-2)
  EXPECT_EQ(x.inputs(1, 17), 1002);
  EXPECT_EQ(x.inputs(1, 18), 1003);   // c(t)
  EXPECT_EQ(x.inputs(1, 19), -1003);  // The other axis.
  EXPECT_EQ(x.targets(1, 0), 1004);   // c(t+1)
  EXPECT_EQ(y.inputs(1, 16), -1001);
  EXPECT_EQ(y.inputs(1, 19), 1003);
  EXPECT_EQ(y.targets(1, 0), -1004);
}

TEST(MakeSway, ObeysThePendulumWithinTheNoise) {
  const LoadClip clip = MakeSway({.seconds = 20, .rate_hz = 60, .noise_sd = 0}, 3);
  ASSERT_EQ(clip.size(), 1200u);
  double worst_m = 0;
  for (std::size_t t = 1; t + 1 < clip.size(); ++t) {
    const double weight = std::accumulate(clip[t].load.begin(), clip[t].load.end(), 0.0);
    const auto sum = [&](std::initializer_list<int> cells) {
      double loads = 0;
      for (const int k : cells) loads += clip[t].load[static_cast<std::size_t>(k)];
      return loads;
    };
    const double cop_x_m = 0.119 * (sum({0, 1, 4, 5}) - sum({2, 3, 6, 7})) / weight;
    const Eigen::Vector2d acceleration_mps2 =
        (clip[t + 1].c_W_m - 2 * clip[t].c_W_m + clip[t - 1].c_W_m) * 3600;
    // c - cop = height / (g weight) c'': between heights of 0.6 m and 1.4 m.
    const double lever_m = (clip[t].c_W_m.x() - cop_x_m) * 9.80665 * weight;
    const double low_m = 0.6 * acceleration_mps2.x(), high_m = 1.4 * acceleration_mps2.x();
    worst_m =
        std::max({worst_m, std::min(low_m, high_m) - lever_m, lever_m - std::max(low_m, high_m)});
  }
  EXPECT_LT(worst_m, 0.01);
  EXPECT_NE(MakeSway({}, 3)[100].c_W_m, MakeSway({}, 4)[100].c_W_m);
}

TEST(ClosedLoop, DivergesWithoutNoiseInTrainingAndComesBackWithIt) {
  // Section 4.2 says nothing of this: a network with a perfect past is a double integrator.
  const LoadClip train = MakeSway({.seconds = 40, .rate_hz = 60, .noise_sd = 0.0013}, 1);
  const LoadClip fresh = MakeSway({.seconds = 40, .rate_hz = 60, .noise_sd = 0.0013}, 2);
  CascadeOptions options;
  options.hidden_max = 3;
  const auto trained = [&](int axis, double noise_m) {
    const Examples examples = WithFeedbackNoise(
        HorizontalExamples({&train, 1}, axis),
        {.groups = FeedbackColumns(), .common_sd = noise_m, .own_sd = noise_m / 10, .copies = 1},
        5);
    return TrainCascade(examples, {}, options, 6).network;
  };
  const auto x_clean = trained(0, 0), y_clean = trained(1, 0);
  EXPECT_LT(MeanSquaredError(x_clean, HorizontalExamples({&fresh, 1}, 0)), 1e-8) << "0.1 mm a step";
  const Eigen::Vector2d clean_m = ClosedLoopError({x_clean, y_clean}, fresh);
  EXPECT_GT(clean_m.maxCoeff(), 0.2);
  const Eigen::Vector2d noisy_m = ClosedLoopError({trained(0, 0.02), trained(1, 0.02)}, fresh);
  EXPECT_LT(noisy_m.maxCoeff(), 0.06);
  EXPECT_TRUE(clean_m.allFinite() && noisy_m.allFinite());
}

TEST(RolledOutExamples, HaveTheNetworksOwnPastAndTheTrueFuture) {
  const LoadClip clip = MakeSway({.seconds = 8, .rate_hz = 60, .noise_sd = 0.0013}, 1);
  CascadeOptions options;
  options.hidden_max = 0;
  const auto trained = [&](int axis) {
    return TrainCascade(HorizontalExamples({&clip, 1}, axis), {}, options, 6).network;
  };
  const Networks networks{trained(0), trained(1)};
  const Examples truth = HorizontalExamples({&clip, 1}, 0);
  const Examples own = RolledOutExamples(networks, {&clip, 1}, 0, 2);
  ASSERT_EQ(own.rows(), truth.rows());
  EXPECT_EQ(own.targets, truth.targets);
  EXPECT_EQ(own.inputs.leftCols(16), truth.inputs.leftCols(16)) << "loads";
  for (const Eigen::Index start : {0, 120, 240}) {
    EXPECT_EQ(own.inputs.row(start), truth.inputs.row(start)) << "begun from the truth";
  }
  // The row after a start has the network's answer to the start as c(t).
  std::vector<float> inputs;
  for (const double value : own.inputs.row(120)) inputs.push_back(static_cast<float>(value));
  std::array<float, 1> answer{};
  networks[0].Evaluate(inputs, answer);
  EXPECT_NEAR(own.inputs(121, 18), answer[0], 1e-6);
  EXPECT_NE(own.inputs(121, 18), truth.inputs(121, 18));
}

TEST(PartsInPlace, AreTheLongRunsNearTheOrigin) {
  LoadClip clip(600);
  clip[100].c_W_m = {0.5, 0};    // 100 frames before it: under three seconds.
  clip[350].c_W_m = {0, -0.41};  // 249 and 249 around it.
  const auto parts = PartsInPlace(clip);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].size(), 249u);
  EXPECT_EQ(parts[1].size(), 249u);
}

}  // namespace
}  // namespace footing::learning
