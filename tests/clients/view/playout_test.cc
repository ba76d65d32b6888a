#include "clients/view/scene/model.h"

#include <gtest/gtest.h>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kMs = 1'000'000;

WorldFrame FrameAt(double time_s, double x_m) {
  CharacterPose pose;
  pose.valid = true;
  pose.com_m = {x_m, 0, 1};
  pose.links.resize(1);
  pose.links[0].position_m = {x_m, 0, 1};
  WorldFrame frame;
  frame.time_s = time_s;
  frame.characters.push_back(pose);
  return frame;
}

double XAt(const Playout& playout, std::int64_t now_ns) {
  return playout.At(now_ns).characters.at(0).com_m.x();
}

TEST(Between, HalfwayIsTheMeanOfPositionsAndTheMiddleOfTheTurn) {
  WorldFrame a = FrameAt(1.0, 0), b = FrameAt(1.1, 0.2);
  b.characters[0].links[0].orientation = Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ());
  const WorldFrame half = Between(a, b, 0.5);
  EXPECT_NEAR(half.time_s, 1.05, 1e-12);
  EXPECT_NEAR(half.characters[0].com_m.x(), 0.1, 1e-12);
  const Eigen::Quaterniond expected(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()));
  EXPECT_LT(half.characters[0].links[0].orientation.angularDistance(expected), 1e-9);
}

TEST(Between, ACharacterThatWasPutBackDoesNotFlyThere) {
  const WorldFrame between = Between(FrameAt(1.0, 5), FrameAt(1.01, 2), 0.5);
  EXPECT_EQ(between.characters[0].com_m.x(), 5);
  EXPECT_EQ(Between(FrameAt(1.0, 5), FrameAt(1.01, 2), 1).characters[0].com_m.x(), 2);
}

TEST(Playout, RunsOneFrameIntervalBehind) {
  Playout playout;
  // 2 m/s at 100 Hz, no delay: at 1.000 s the frame of 0.990 s is due.
  for (int i = 0; i <= 100; ++i) playout.Push(FrameAt(0.01 * i, 0.02 * i), 10 * kMs * i);
  EXPECT_NEAR(XAt(playout, 1000 * kMs), 2 * 0.990, 1e-9);
  EXPECT_NEAR(XAt(playout, 1005 * kMs), 2 * 0.995, 1e-9);
}

TEST(Playout, ArrivalInBurstsDoesNotShow) {
  Playout playout;
  // Every frame but each fourth is late; the fourth is on time and sets the pace.
  std::int64_t shown_at_ns = 0;
  for (int i = 0; i <= 100; ++i) {
    const std::int64_t late_ns = (3 - i % 4) * 2 * kMs;
    playout.Push(FrameAt(0.01 * i, 0.02 * i), 10 * kMs * i + late_ns);
    shown_at_ns = 10 * kMs * i + 8 * kMs;
    if (i > 8) {
      EXPECT_NEAR(XAt(playout, shown_at_ns), 2 * (0.01 * i - 0.002), 1e-9) << i;
    }
  }
}

TEST(Playout, TheNewestFrameStandsWhenTheStreamStops) {
  Playout playout;
  for (int i = 0; i <= 10; ++i) playout.Push(FrameAt(0.01 * i, 0.02 * i), 10 * kMs * i);
  EXPECT_NEAR(XAt(playout, 60'000 * kMs), 0.2, 1e-12);
}

TEST(Playout, AServerStartedAnewStartsThePlayoutAnew) {
  Playout playout;
  for (int i = 0; i <= 10; ++i) playout.Push(FrameAt(5 + 0.01 * i, 7), 10 * kMs * i);
  playout.Push(FrameAt(0.01, 0), 200 * kMs);
  EXPECT_EQ(XAt(playout, 300 * kMs), 0);
  EXPECT_EQ(playout.Newest().time_s, 0.01);
}

}  // namespace
}  // namespace footing::scene
