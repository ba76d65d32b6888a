#include "tests/common/net/server_fixture.h"

/// A server that hands on another one's ticks under their own numbers.
namespace footing::transport {
namespace {

class ServerRelayTest : public ServerFixture {
 protected:
  void StartRelay() {
    ServerOptions options = Options();
    options.epoch = 77;
    StartServer(options);
    v1::DeviceStatusList list;
    list.add_devices()->set_serial("of the source");
    server_->BeginAt({1000, now_ns_}, {{16, list.SerializeAsString()}});
  }
  void Relay(std::uint64_t sequence, std::uint64_t missing_from = 0) {
    v1::MotionSamples motion;
    motion.add_samples()->set_report_count(sequence);
    // As far apart as ticks of 100 Hz.
    const auto host_ns = static_cast<std::int64_t>(sequence) * 10'000'000;
    server_->Relay({sequence, host_ns, missing_from}, {{17, motion.SerializeAsString()}});
  }
  static v1::Envelope ResumeFrom(std::uint64_t sequence) {
    v1::Envelope message = Subscribe();
    message.mutable_subscribe()->set_from_sequence(sequence);
    message.mutable_subscribe()->set_from_epoch(77);
    return message;
  }
  bool WaitForTick(const TestClient& client, std::uint64_t sequence) {
    return RunUntil([&] {
      const auto sequences = client.Sequences();
      return !sequences.empty() && sequences.back() >= sequence;
    });
  }
  static std::vector<std::pair<std::uint64_t, std::uint64_t>> Gaps(const TestClient& client) {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps;
    for (const auto& message : client.messages) {
      if (message.has_gap())
        gaps.emplace_back(message.gap().from_sequence(), message.gap().to_sequence());
    }
    return gaps;
  }
  using Pairs = std::vector<std::pair<std::uint64_t, std::uint64_t>>;
};

TEST_F(ServerRelayTest, EpochSequenceAndTimesAreThoseOfTheSource) {
  StartRelay();
  const auto client = Subscribed(Subscribe());
  EXPECT_EQ(client->Find(v1::Envelope::kWelcome)->welcome().epoch(), 77u);
  const v1::Tick& snapshot = client->Find(v1::Envelope::kTick)->tick();
  EXPECT_EQ(snapshot.sequence(), 1000u);
  EXPECT_EQ(snapshot.status().devices(0).serial(), "of the source");
  Relay(1001);
  Relay(1004);  // Two were left out on purpose: that is not a Gap.
  ASSERT_TRUE(WaitForTick(*client, 1004));
  EXPECT_EQ(client->Sequences(), (std::vector<std::uint64_t>{1001, 1004}));
  EXPECT_EQ(client->messages.back().tick().epoch(), 77u);
  EXPECT_EQ(client->messages.back().tick().host_ns(), 10'040'000'000);
  EXPECT_TRUE(Gaps(*client).empty());
}

TEST_F(ServerRelayTest, WhatWasLostOnTheWayToItIsAGapInFrontOfTheNextTick) {
  StartRelay();
  const auto client = Subscribed(Subscribe());
  Relay(1001);
  Relay(1010, 1003);
  ASSERT_TRUE(WaitForTick(*client, 1010));
  EXPECT_EQ(Gaps(*client), (Pairs{{1003, 1009}}));
  EXPECT_TRUE(client->messages[client->messages.size() - 2].has_gap());
}

TEST_F(ServerRelayTest, ASessionWithARateGetsEveryGap) {
  StartRelay();
  v1::Envelope wish = Subscribe();
  wish.mutable_subscribe()->set_max_hz(10);
  const auto client = Subscribed(wish);
  Relay(1001);
  Relay(1004, 1003);  // Not due for 10 Hz.
  Relay(1005);
  ASSERT_TRUE(WaitForTick(*client, 1004));
  Settle();
  EXPECT_EQ(Gaps(*client), (Pairs{{1003, 1003}}));
  EXPECT_EQ(client->Sequences(), (std::vector<std::uint64_t>{1001, 1004}));
}

TEST_F(ServerRelayTest, AResumeGetsTicksAndGapsOutOfTheRing) {
  StartRelay();
  for (const std::uint64_t sequence : {1001u, 1004u, 1007u}) Relay(sequence);
  Relay(1020, 1010);
  const auto client = Subscribed(ResumeFrom(1002));
  ASSERT_TRUE(WaitForTick(*client, 1020));
  EXPECT_EQ(client->Sequences(), (std::vector<std::uint64_t>{1004, 1007, 1020}));
  EXPECT_EQ(Gaps(*client), (Pairs{{1010, 1019}}));
  v1::Envelope refill;
  refill.mutable_refill()->set_from_sequence(1001);
  refill.mutable_refill()->set_to_sequence(1005);
  client->Send(refill);
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 5; }));
  EXPECT_EQ(client->Sequences()[3], 1001u);
  EXPECT_EQ(client->Sequences()[4], 1004u);
}

TEST_F(ServerRelayTest, AResumeGetsNoNumberTwice) {
  StartRelay();
  Relay(1010, 1001);
  Relay(1020, 1011);
  // The ring begins behind a hole that is within the Gap of the resume.
  const auto before = Subscribed(ResumeFrom(990));
  ASSERT_TRUE(WaitForTick(*before, 1020));
  EXPECT_EQ(Gaps(*before), (Pairs{{990, 1009}, {1011, 1019}}));
  // Another relay of the same server had a part of what is missing here.
  const auto within = Subscribed(ResumeFrom(1015));
  ASSERT_TRUE(WaitForTick(*within, 1020));
  EXPECT_EQ(Gaps(*within), (Pairs{{1015, 1019}}));
}

TEST_F(ServerRelayTest, ADroppedTickTakesItsGapIntoTheGapOfTheQueue) {
  StartRelay();
  const auto client = Connect();
  client->Send(Hello());
  client->Send(Subscribe(v1::QUEUE_POLICY_LATEST));
  ASSERT_TRUE(RunUntil([&] { return server_->statistics().sessions == 1; }));
  Settle();
  // Longer than what the kernel takes while nobody reads.
  v1::RawReports raw;
  raw.add_reports()->set_report(std::string(100'000, 'r'));
  std::uint64_t sequence = 1001;
  while (server_->statistics().ticks_dropped == 0) {
    server_->Relay({sequence, 0, sequence - 1}, {{20, raw.SerializeAsString()}});
    sequence += 2;
    Settle();
    ASSERT_LT(sequence, 2000u);
  }
  server_->Relay({sequence, 0, sequence - 1}, {});
  client->Read();
  ASSERT_TRUE(WaitForTick(*client, sequence));
  // Every number is there once: as a tick or within a Gap.
  std::uint64_t next = 1000;
  for (const auto& message : client->messages) {
    if (message.has_gap()) {
      EXPECT_EQ(message.gap().from_sequence(), next);
      next = message.gap().to_sequence() + 1;
    } else if (message.has_tick() && !message.tick().snapshot()) {
      EXPECT_EQ(message.tick().sequence(), next);
      ++next;
    }
  }
  EXPECT_EQ(next, sequence + 1);
}

}  // namespace
}  // namespace footing::transport
