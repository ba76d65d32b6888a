#include "clients/view/scene/model.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/clients/view/made_stream.h"

namespace footing::scene {
namespace {

constexpr std::int64_t kStripMs = 1'000'000;

TEST(Strip, KeepsTenSecondsAndNoMore) {
  Strip strip;
  for (int i = 0; i < 2000; ++i) strip.Add(10 * kStripMs * i, i);
  EXPECT_EQ(strip.points().front().time_ns, 10 * kStripMs * 1999 - kStripNs);
  EXPECT_EQ(strip.points().back().value, 1999);
}

TEST(Strip, WhatIsNotKnownLeavesAGapAndNoZero) {
  Strip strip;
  strip.Add(0, 1);
  strip.Break(10 * kStripMs);
  strip.Add(20 * kStripMs, 2);
  strip.Add(30 * kStripMs, std::numeric_limits<double>::quiet_NaN());
  strip.Add(40 * kStripMs, 3);
  strip.Add(50 * kStripMs, 4);
  ASSERT_EQ(strip.points().size(), 4u);
  EXPECT_FALSE(strip.points()[1].joined);
  EXPECT_FALSE(strip.points()[2].joined);
  EXPECT_TRUE(strip.points()[3].joined);
}

TEST(Strip, WhatHasLeftTheStripGoesAlsoWhileNothingIsKnown) {
  Strip strip;
  strip.Add(0, 1);
  strip.Add(1000 * kStripMs, 2);
  strip.Break(kStripNs + 500 * kStripMs);
  ASSERT_EQ(strip.points().size(), 1u);
  strip.Break(kStripNs + 1500 * kStripMs);
  EXPECT_TRUE(strip.points().empty());
}

TEST(StripSet, AStreamOfManyDevicesStaysBounded) {
  StripSet strips;
  Update update;
  for (std::uint32_t device = 0; device < 100; ++device) {
    stream::MotionSample sample;
    sample.device = device;
    update.motion.push_back(sample);
  }
  strips.Add(update);
  EXPECT_EQ(strips.devices.size(), 16u);
}

TEST(StripSet, FeaturesOfTheMadeStreamArrive) {
  const Model model = made::ModelAfter(4, {});
  ASSERT_EQ(model.strips.devices.size(), 2u);
  const DeviceStrips& left = model.strips.devices.begin()->second;
  EXPECT_EQ(left.role, stream::DeviceRole::kLeftHand);
  EXPECT_TRUE(left.simulated);
  EXPECT_FLOAT_EQ(left.frequency_hz.points().back().value, 2.6f);  // Twice the cadence of 1.3 Hz.
  // The frequency is unknown for the first 2.5 s.
  EXPECT_GT(left.frequency_hz.points().front().time_ns, made::ClockAt(2.5) - 1);
  EXPECT_EQ(model.strips.phases_rad.size(), 1u);
}

}  // namespace
}  // namespace footing::scene
