#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/net/monitoring.h"
#include "common/wire/wire.h"
#include "tests/common/net/server_fixture.h"

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

using transport::ChannelBytes;

constexpr std::int64_t kTickNs = 10'000'000;

class StatsCollectorTest : public transport::ServerFixture {
 protected:
  void SetUp() override {
    transport::ServerOptions options = Options();
    options.channels.push_back(StatsChannel());
    options.ping_interval_s = 0.02;
    StartServer(options);
    collector_ = std::make_unique<StatsCollector>(*server_, 100);
  }

  /// Publishes `ticks` ticks, each `late_ns` late.
  void Run(int ticks, std::int64_t late_ns = 0) {
    for (int i = 0; i < ticks; ++i) {
      now_ns_ += kTickNs;
      std::vector<ChannelBytes> channels{{17, ""}};
      collector_->OnTick({now_ns_, now_ns_ - late_ns, {}}, channels);
      published_ += channels.size() - 1;
      server_->Publish(now_ns_, channels);
    }
  }

  std::unique_ptr<StatsCollector> collector_;
  std::size_t published_ = 0;
};

TEST_F(StatsCollectorTest, TheFirstTickAndThenOneASecondHasTheStats) {
  Run(1);
  EXPECT_EQ(published_, 1u);
  Run(99);
  EXPECT_EQ(published_, 1u);
  Run(301);
  EXPECT_EQ(published_, 5u);  // At 0, 1, 2, 3 and 4 s.
  EXPECT_NEAR(collector_->newest().ticks.rate_hz, 100, 0.1);
  EXPECT_NEAR(collector_->newest().uptime_s, 4, 0.02);
  EXPECT_EQ(collector_->newest().ticks.ticks, 401u);
  EXPECT_EQ(collector_->newest().ticks.overruns, 0u);
}

TEST_F(StatsCollectorTest, ATickMoreThanAPeriodLateIsAnOverrun) {
  Run(10);
  Run(3, kTickNs + 1);
  Run(200, kTickNs / 2);
  EXPECT_EQ(collector_->newest().ticks.overruns, 3u);
  EXPECT_NEAR(collector_->newest().ticks.late_max_s, 0.005, 1e-9) << "of the last second alone";
}

TEST_F(StatsCollectorTest, AServersOwnCountOfOverrunsIsTaken) {
  std::vector<ChannelBytes> channels;
  collector_->OnTick({now_ns_, {}, 7}, channels);
  EXPECT_EQ(collector_->newest().ticks.overruns, 7u);
}

TEST_F(StatsCollectorTest, LateTicksAndDroppedOnesAndWaitsAreCounted) {
  server_->NoteLateTicks(12);
  Run(1);
  EXPECT_EQ(collector_->newest().ticks.left_out, 12u);
}

TEST_F(StatsCollectorTest, AClientSeesItselfWithItsQueueItsLagAndItsClock) {
  const auto client = Subscribed(Subscribe(v1::QUEUE_POLICY_RELIABLE, 500));
  Run(1);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kPing));
  v1::Envelope pong;
  const v1::Ping ping = client->Find(v1::Envelope::kPing)->ping();
  pong.mutable_pong()->set_id(ping.id());
  pong.mutable_pong()->set_t0_ns(ping.t0_ns());
  // A clock 5 s ahead: it arrives at once, since the server's clock stands still here.
  pong.mutable_pong()->set_t1_ns(ping.t0_ns() + 5 * kNanosecondsPerSecond);
  pong.mutable_pong()->set_t2_ns(ping.t0_ns() + 5 * kNanosecondsPerSecond);
  client->Send(pong);
  ASSERT_TRUE(RunUntil([&] { return server_->sessions().at(0).clock_valid; }));
  const std::int64_t behind_ns = now_ns_ - ping.t0_ns();
  const stream::SessionStats stats = server_->sessions().at(0);
  EXPECT_EQ(stats.client_name, "test");
  EXPECT_EQ(stats.role, "view");
  EXPECT_TRUE(stats.local);
  EXPECT_EQ(stats.policy, "reliable");
  EXPECT_EQ(stats.queue_capacity, 500u);
  EXPECT_EQ(stats.ticks_sent, 1u);
  EXPECT_NEAR(stats.clock_offset_s, 5, 1e-9 * static_cast<double>(behind_ns) + 1e-6);
  Run(101);
  Settle();
  const v1::Envelope* last = nullptr;
  for (const v1::Envelope& message : client->messages) {
    if (message.has_tick() && message.tick().has_stats()) last = &message;
  }
  ASSERT_NE(last, nullptr);
  const stream::ServerStats received = wire::FromProto(last->tick().stats());
  ASSERT_EQ(received.sessions.size(), 1u);
  EXPECT_EQ(received.sessions[0].client_name, "test");
  EXPECT_EQ(received.session_count, 1u);
}

TEST_F(StatsCollectorTest, StampsWithoutSenseAreIgnored) {
  const auto client = Subscribed(Subscribe());
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kPing));
  for (const std::int64_t stamp : {INT64_MIN, std::int64_t{0}, INT64_MAX}) {
    v1::Envelope pong;
    pong.mutable_pong()->set_id(client->Find(v1::Envelope::kPing)->ping().id());
    pong.mutable_pong()->set_t1_ns(stamp);
    pong.mutable_pong()->set_t2_ns(stamp);
    client->Send(pong);
  }
  Settle();
  EXPECT_FALSE(server_->sessions().at(0).clock_valid);
}

TEST_F(StatsCollectorTest, AReaderThatStandsStillLagsAndLosesTicks) {
  auto client = Connect();
  client->Read();
  client->Send(Hello());
  client->Send(Subscribe(v1::QUEUE_POLICY_DROP_OLDEST, 20));
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kTick));
  auto stalled = std::make_unique<transport::TestClient>(DialServer());
  stalled->Send(Hello());
  stalled->Send(Subscribe(v1::QUEUE_POLICY_DROP_OLDEST, 20));
  ASSERT_TRUE(RunUntil([&] {
    return server_->sessions().size() == 2 && !server_->sessions().at(1).policy.empty();
  }));
  for (int i = 0; i < 200; ++i) PublishMotion(50'000);
  const stream::SessionStats slow = server_->sessions().at(1);
  EXPECT_EQ(slow.queue_ticks, 20u);
  EXPECT_GT(slow.ticks_dropped, 0u);
  EXPECT_NEAR(slow.lag_s, 0.19, 1e-9);  // 20 wait, 10 ms apart, the newest is 0 s old.
}

TEST(MostLagging, TheOnesThatLagMostThenThoseThatLostMost) {
  std::vector<stream::SessionStats> sessions(5);
  for (std::size_t i = 0; i < 5; ++i) sessions[i].session = i + 1;
  sessions[3].lag_s = 2;
  sessions[1].ticks_dropped = 9;
  const auto kept = MostLagging(sessions, 3);
  ASSERT_EQ(kept.size(), 3u);
  EXPECT_EQ(kept[0].session, 4u);
  EXPECT_EQ(kept[1].session, 2u);
  EXPECT_EQ(kept[2].session, 1u);
  EXPECT_EQ(MostLagging(sessions, 9).size(), 5u);
}

TEST(ServerStats, SurvivesTheWayThroughAMessage) {
  stream::ServerStats stats;
  stats.ticks = {10, 99.5, 0.25, 1, 2};
  stats.session_count = 3;
  stats.sessions.push_back(
      {7, "v", "view", true, 1.5, "latest", 1, 2, 0.5, 10, 11, 12, true, -0.5, 0.25});
  stats.devices.push_back({1, "aa", stream::DeviceKind::kWiimote, stream::DeviceState::kLive,
                           "main", stream::DeviceRole::kLeftHand, true, 98.5, 0.5, 1, 2, 3, 4, 5,
                           0.75});
  const v1::ServerStats message = wire::ToProto(stats);
  EXPECT_EQ(wire::ToProto(wire::FromProto(message)).SerializeAsString(),
            message.SerializeAsString());
  EXPECT_EQ(message.sessions(0).clock_uncertainty_s(), 0.25);
  EXPECT_EQ(message.devices(0).battery_fraction(), 0.75);
  EXPECT_EQ(message.ticks().left_out(), 2u);
}

}  // namespace
}  // namespace footing::monitoring
