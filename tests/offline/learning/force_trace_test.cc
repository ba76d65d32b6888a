#include "daemon/offline/learning/force_trace.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace footing::learning {
namespace {

constexpr double kWeightN = 700;

/// Standing on both feet for so long.
ForceTrace Standing(double seconds) {
  ForceTrace trace;
  trace.weight_n = kWeightN;
  trace.load_n.setConstant(2, static_cast<Eigen::Index>(seconds * trace.rate_hz), kWeightN / 2);
  trace.valid.assign(static_cast<std::size_t>(trace.load_n.cols()), true);
  return trace;
}

/// The right foot is off the ground for half a second and comes down at `time_s` with a push of
/// `over` weights that is 60 ms wide.
void AddStomp(double time_s, double over, ForceTrace& trace) {
  for (Eigen::Index i = 0; i < trace.load_n.cols(); ++i) {
    const double t_s = static_cast<double>(i) / trace.rate_hz - time_s;
    if (t_s > -0.55 && t_s < -0.05) trace.load_n.col(i) << kWeightN, 0;
    trace.load_n(1, i) += over * kWeightN * std::exp(-0.5 * t_s * t_s / (0.025 * 0.025));
  }
}

TEST(FindStomps, FindsEachStompAtItsPush) {
  ForceTrace trace = Standing(20);
  for (const double time_s : {5.0, 6.1, 7.8}) AddStomp(time_s, 1.0, trace);
  const auto stomps = FindStomps(trace);
  ASSERT_EQ(stomps.size(), 3u);
  EXPECT_NEAR(stomps[0].time_s, 5.0, 0.011);
  EXPECT_NEAR(stomps[1].time_s, 6.1, 0.011);
  EXPECT_NEAR(stomps[2].time_s, 7.8, 0.011);
}

TEST(FindStomps, APushOfAStandingBodyIsNone) {
  // GIVEN a squat's push with both feet on the ground, short enough to be a stomp's.
  ForceTrace trace = Standing(10);
  for (Eigen::Index i = 500; i < 520; ++i)
    trace.load_n.col(i) *= 1 + 0.6 * std::sin(std::numbers::pi * static_cast<double>(i - 500) / 20);
  EXPECT_TRUE(FindStomps(trace).empty());
}

TEST(FindStomps, ALongPushAndAWeakOneAreNone) {
  ForceTrace trace = Standing(20);
  AddStomp(5, 0.05, trace);
  AddStomp(10, 0, trace);
  for (Eigen::Index i = 1000; i < 1080; ++i) trace.load_n.col(i) *= 1.4;
  EXPECT_TRUE(FindStomps(trace).empty());
}

TEST(FindStomps, WhereNothingWasMeasuredThereIsNone) {
  ForceTrace trace = Standing(10);
  AddStomp(5, 1, trace);
  trace.valid[490] = false;
  EXPECT_TRUE(FindStomps(trace).empty());
}

}  // namespace
}  // namespace footing::learning
