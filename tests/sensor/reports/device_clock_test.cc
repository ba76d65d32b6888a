#include "daemon/sensor/reports/device_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/virtual/devices/link_model.h"

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

/// rms and 99th percentile of |sampled - true|, in ms, after removing the median.
struct Accuracy {
  double rms_ms = 0;
  double p99_ms = 0;
  bool monotonic = true;
};

Accuracy Measure(virtual_devices::LinkConfig link, double sensor_period_s, double from_s,
                 double to_s) {
  virtual_devices::LinkModel model(link, 0);
  DeviceClockConfig config;
  config.nominal_period_s = 1 / link.nominal_rate_hz;
  config.sensor_period_s = sensor_period_s;
  DeviceClock clock(config);
  std::vector<double> errors_ms;
  std::int64_t held_ns = -1, last_ns = 0;
  Accuracy accuracy;
  for (;;) {
    const auto arrival = model.Next();
    if (static_cast<double>(arrival.arrives_ns) * 1e-9 > to_s) break;
    const std::int64_t sampled_ns =
        clock.Advance(arrival.arrives_ns, arrival.sampled_ns != held_ns);
    held_ns = arrival.sampled_ns;
    accuracy.monotonic = accuracy.monotonic && sampled_ns >= last_ns;
    last_ns = sampled_ns;
    if (static_cast<double>(arrival.arrives_ns) * 1e-9 < from_s) continue;
    errors_ms.push_back(static_cast<double>(sampled_ns - arrival.sampled_ns) * 1e-6);
  }
  std::sort(errors_ms.begin(), errors_ms.end());
  const double median_ms = errors_ms[errors_ms.size() / 2];
  double squares = 0;
  for (double& error : errors_ms) {
    error = std::abs(error - median_ms);
    squares += error * error;
  }
  std::sort(errors_ms.begin(), errors_ms.end());
  accuracy.rms_ms = std::sqrt(squares / static_cast<double>(errors_ms.size()));
  accuracy.p99_ms = errors_ms[errors_ms.size() * 99 / 100];
  return accuracy;
}

TEST(DeviceClock, FindsTheSensorsOwnTicksOnAGoodLink) {
  // The sensor's rate is off by 0, 50 ppm, 0.5 % and -1 %.
  for (const double factor : {1.0, 1.00005, 1.005, 0.99}) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
      auto wiimote = virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, seed);
      wiimote.sensor_rate_hz *= factor;
      const Accuracy of_wiimote = Measure(wiimote, 0.01, 5, 120);
      EXPECT_LE(of_wiimote.rms_ms, 2) << factor << " seed " << seed;
      EXPECT_LE(of_wiimote.p99_ms, 6) << factor << " seed " << seed;
      EXPECT_TRUE(of_wiimote.monotonic);
      auto board = virtual_devices::BoardLink(virtual_devices::LinkQuality::kGood, seed);
      board.sensor_rate_hz *= factor;
      const Accuracy of_board = Measure(board, 1 / 60.0, 5, 120);
      EXPECT_LE(of_board.rms_ms, 2) << factor << " seed " << seed;
      EXPECT_LE(of_board.p99_ms, 6) << factor << " seed " << seed;
    }
  }
}

TEST(DeviceClock, OnAPoorLinkTheErrorStaysFarBelowAPeriod) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto link = virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kPoor, seed);
    const Accuracy accuracy = Measure(link, 0.01, 5, 600);
    EXPECT_LE(accuracy.rms_ms, 2.9) << "no better than the arrival itself";
    EXPECT_TRUE(accuracy.monotonic);
  }
}

TEST(DeviceClock, ASensorAtRestDoesNotDisturbTheGrid) {
  // Moves for 20 s, rests for 20 s (all values the same), moves again.
  virtual_devices::LinkModel link(
      virtual_devices::WiimoteLink(virtual_devices::LinkQuality::kGood, 4), 0);
  DeviceClock clock;
  std::int64_t held_ns = -1;
  double worst_ms = 0;
  for (int i = 0; i < 6000; ++i) {
    const auto arrival = link.Next();
    const double at_s = static_cast<double>(arrival.arrives_ns) * 1e-9;
    const bool rests = at_s > 20 && at_s < 40;
    const auto sampled_ns =
        clock.Advance(arrival.arrives_ns, !rests && arrival.sampled_ns != held_ns);
    held_ns = arrival.sampled_ns;
    if (at_s < 42 || at_s > 50) continue;
    worst_ms =
        std::max(worst_ms, std::abs(static_cast<double>(sampled_ns - arrival.sampled_ns)) * 1e-6);
  }
  EXPECT_TRUE(clock.held());
  EXPECT_LE(worst_ms, 10.5);
  EXPECT_NEAR(clock.period_s(), 0.01, 0.0001);
}

TEST(DeviceClock, StaysBetweenTheArrivalAndTheLagOnAnyLink) {
  for (const auto quality :
       {virtual_devices::LinkQuality::kGood, virtual_devices::LinkQuality::kPoor}) {
    virtual_devices::LinkModel link(virtual_devices::BoardLink(quality, 3), 0);
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
