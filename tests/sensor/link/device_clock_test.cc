#include "daemon/sensor/link/device_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/device_models/link_model.h"

namespace footing::link {
namespace {

double Sd(const std::vector<double>& values) {
  double mean = 0, square = 0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) {
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  }
  return std::sqrt(square);
}

TEST(DeviceClock, SmoothsTheBurstsOfASteadyDevice) {
  // Samples every 10.02 ms; each report waits up to 16 ms, in order, as Bluetooth delivers.
  std::mt19937 random(2);
  DeviceClock clock;
  std::vector<double> received_error_ms, sampled_error_ms;
  double last_arrival_ms = 0;
  for (int i = 0; i < 5000; ++i) {
    const double true_ms = 10.02 * i;
    const double wait_ms = 2 + 14 * (static_cast<double>(random() % 1000) / 1000);
    last_arrival_ms = std::max(last_arrival_ms, true_ms + wait_ms);
    const auto received_ns = static_cast<std::int64_t>(last_arrival_ms * 1e6);
    const double sampled_ms = static_cast<double>(clock.Advance(received_ns)) * 1e-6;
    if (i < 500) continue;
    received_error_ms.push_back(last_arrival_ms - true_ms);
    sampled_error_ms.push_back(sampled_ms - true_ms);
  }
  EXPECT_LT(Sd(sampled_error_ms), 0.6 * Sd(received_error_ms));
  EXPECT_NEAR(clock.period_s(), 0.01002, 0.0005);
}

TEST(DeviceClock, StaysBetweenTheArrivalAndTheLagOnAnyLink) {
  for (const auto quality :
       {device_models::LinkQuality::kGood, device_models::LinkQuality::kPoor}) {
    device_models::LinkModel link(device_models::BoardLink(quality, 3), 0);
    DeviceClockConfig config;
    config.nominal_period_s = 1 / 83.6;
    DeviceClock clock(config);
    std::int64_t before_ns = -1;
    for (int i = 0; i < 20'000; ++i) {
      const std::int64_t received_ns = link.Next().arrives_ns;
      const std::int64_t sampled_ns = clock.Advance(received_ns);
      ASSERT_LE(sampled_ns, received_ns);
      ASSERT_GE(sampled_ns, received_ns - 25'000'000);
      ASSERT_GE(sampled_ns, before_ns);
      before_ns = sampled_ns;
    }
  }
}

TEST(DeviceClock, StartsAnewAfterAPause) {
  DeviceClock clock;
  for (int i = 0; i < 100; ++i) clock.Advance(i * std::int64_t{10'000'000});
  EXPECT_EQ(clock.Advance(30'000'000'000), 30'000'000'000);
}

}  // namespace
}  // namespace footing::link
