#include "common/net/prometheus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace footing::monitoring {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

stream::ServerStats Stats() {
  stream::ServerStats stats;
  stats.ticks.ticks = 1234;
  stats.ticks.late_max_s = 0.0015;
  stream::SessionStats session;
  session.session = 3;
  session.client_name = "a \"quote\" and a \\";
  session.role = "view";
  session.lag_s = 0.25;
  stats.sessions = {session};
  stream::DeviceStats device;
  device.serial = "00:1f";
  device.state = stream::DeviceState::kLive;
  device.jitter_s = 0.5;
  stats.devices = {device};
  return stats;
}

std::string Text(const stream::ServerStats& stats) {
  return PrometheusText(stats, {"footingd", "1.2"}, {1.5, 4096, 7});
}

TEST(Prometheus, EveryMetricHasHelpAndTypeAndTheBaseUnitInItsName) {
  const std::string text = Text(Stats());
  EXPECT_THAT(text, HasSubstr("# TYPE footing_ticks_total counter\nfooting_ticks_total 1234\n"));
  EXPECT_THAT(text, HasSubstr("# HELP footing_tick_late_max_seconds "));
  EXPECT_THAT(text, HasSubstr("\nfooting_tick_late_max_seconds 0.0015\n"));
  EXPECT_THAT(text, HasSubstr("footing_build_info{program=\"footingd\",version=\"1.2\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("\nprocess_cpu_seconds_total 1.5\n"));
  EXPECT_THAT(text, HasSubstr("\nprocess_resident_memory_bytes 4096\n"));
}

TEST(Prometheus, ALabelsQuotesAndBackslashesAreEscaped) {
  EXPECT_THAT(Text(Stats()),
              HasSubstr("footing_session_lag_seconds{session=\"3\",client=\"a \\\"quote\\\" and a "
                        "\\\\\",role=\"view\"} 0.25\n"));
}

TEST(Prometheus, WhatIsUnknownHasNoSample) {
  EXPECT_THAT(Text(Stats()), Not(HasSubstr("footing_device_battery_ratio{")));
  EXPECT_THAT(Text(Stats()), Not(HasSubstr("footing_session_clock_offset_seconds{")));
  EXPECT_THAT(Text({}), Not(HasSubstr("footing_device")));
  stream::ServerStats known = Stats();
  known.devices[0].battery_fraction = 0.5;
  EXPECT_THAT(Text(known), HasSubstr("role=\"none\""));
  EXPECT_THAT(Text(known), HasSubstr("} 0.5\n"));
}

TEST(ProcessUsage, IsThatOfAProcessThatRuns) {
  const ProcessUsage usage = UsageOfThisProcess();
  EXPECT_GT(usage.cpu_s, 0);
  EXPECT_GT(usage.resident_bytes, 1u << 20);
  EXPECT_GE(usage.open_descriptors, 3u);
  EXPECT_LT(usage.open_descriptors, 100u);
}

}  // namespace
}  // namespace footing::monitoring
