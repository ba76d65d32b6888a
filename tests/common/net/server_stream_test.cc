#include <numeric>

#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

/// from, from + 1, ..., to.
std::vector<std::uint64_t> Range(std::uint64_t from, std::uint64_t to) {
  std::vector<std::uint64_t> range(to - from + 1);
  std::iota(range.begin(), range.end(), from);
  return range;
}

class ServerStreamTest : public ServerFixture {
 protected:
  static v1::Envelope ResumeFrom(std::uint64_t sequence, std::uint64_t epoch) {
    v1::Envelope message = Subscribe();
    message.mutable_subscribe()->set_from_sequence(sequence);
    message.mutable_subscribe()->set_from_epoch(epoch);
    return message;
  }
  /// A client that has subscribed and does not read any more.
  std::unique_ptr<TestClient> Stalled(v1::QueuePolicy policy, std::uint32_t queue_ticks) {
    auto client = Connect();
    client->Send(Hello());
    client->Send(Subscribe(policy, queue_ticks));
    const std::size_t before = server_->statistics().sessions;
    EXPECT_TRUE(RunUntil([&] { return server_->statistics().sessions > before; }));
    Settle();
    return client;
  }
};

TEST_F(ServerStreamTest, TheEffectiveSubscriptionIsEchoed) {
  StartServer();
  v1::Envelope wish = Subscribe(v1::QUEUE_POLICY_RELIABLE, 1'000'000);
  wish.mutable_subscribe()->add_channels("motion");
  wish.mutable_subscribe()->add_channels("smell");
  wish.mutable_subscribe()->set_max_hz(5000);
  const auto client = Subscribed(wish);
  const v1::Subscribed& answer = client->Find(v1::Envelope::kSubscribed)->subscribed();
  ASSERT_EQ(answer.channels_size(), 1);
  EXPECT_EQ(answer.channels(0), "motion");
  ASSERT_EQ(answer.unknown_channels_size(), 1);
  EXPECT_EQ(answer.unknown_channels(0), "smell");
  EXPECT_EQ(answer.max_hz(), 100);         // The tick rate.
  EXPECT_EQ(answer.queue_ticks(), 1024u);  // The server's limit.
  EXPECT_EQ(answer.policy(), v1::QUEUE_POLICY_RELIABLE);
  EXPECT_EQ(answer.first_sequence(), 1u);
}

TEST_F(ServerStreamTest, TheSnapshotComesFirstAndNoTickIsMissingAfterIt) {
  StartServer();
  PublishStatus("before");
  const auto client = Connect();
  client->Read();
  client->Send(Hello());
  client->Send(Subscribe());
  // Ticks are published at every turn of the loop, whatever the handshake does meanwhile.
  ASSERT_TRUE(RunUntil([&] {
    PublishMotion();
    return client->Sequences().size() >= 20;
  }));
  const auto snapshot = std::find_if(client->messages.begin(), client->messages.end(),
                                     [](const auto& message) { return message.has_tick(); });
  EXPECT_TRUE(snapshot->tick().snapshot());
  EXPECT_EQ(snapshot->tick().status().devices(0).serial(), "before");
  const std::uint64_t first =
      client->Find(v1::Envelope::kSubscribed)->subscribed().first_sequence();
  EXPECT_EQ(snapshot->tick().sequence(), first - 1);
  const auto sequences = client->Sequences();
  EXPECT_EQ(sequences, Range(first, first + sequences.size() - 1));
}

TEST_F(ServerStreamTest, OnlyTheChannelsAskedForAreSent) {
  StartServer();
  v1::Envelope wish = Subscribe();
  wish.mutable_subscribe()->add_channels("raw");
  for (const std::size_t listener : {0u, 1u}) {
    const auto client = Subscribed(wish, listener);
    PublishMotion();
    ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 1; }));
    const v1::Tick& tick = client->messages.back().tick();
    EXPECT_FALSE(tick.has_motion());
    EXPECT_EQ(tick.raw().reports(0).report(), std::string(10, 'r'));
    EXPECT_EQ(tick.host_ns(), now_ns_);
    EXPECT_EQ(tick.epoch(), server_->epoch());
  }
}

TEST_F(ServerStreamTest, DecimationIsNoGapAndKeepsRetainedValues) {
  StartServer();
  v1::Envelope wish = Subscribe();
  wish.mutable_subscribe()->set_max_hz(25);
  const auto client = Subscribed(wish);
  PublishMotion();
  now_ns_ += 1'000'000;
  PublishStatus("between");  // 1 ms after a tick that was taken: left out.
  for (int i = 0; i < 99; ++i) PublishMotion();
  ASSERT_TRUE(
      RunUntil([&] { return !client->Sequences().empty() && client->Sequences().back() >= 97; }));
  EXPECT_NEAR(static_cast<double>(client->Sequences().size()), 25, 1);
  EXPECT_EQ(client->Count(v1::Envelope::kGap), 0u);
  const auto carried =
      std::find_if(client->messages.begin(), client->messages.end(), [](const auto& message) {
        return !message.tick().snapshot() && message.tick().status().devices_size() == 1;
      });
  ASSERT_NE(carried, client->messages.end());
  EXPECT_EQ(carried->tick().status().devices(0).serial(), "between");
}

TEST_F(ServerStreamTest, WhoTakesEveryTickGetsItBeforeWhoTakesFewer) {
  StartServer();
  v1::Envelope fewer = Subscribe();
  fewer.mutable_subscribe()->set_max_hz(50);
  const auto picture = Subscribed(fewer), worker = Subscribed(Subscribe());
  for (std::size_t i = 0; i < 20; ++i) {
    PublishMotion();
    const std::size_t shown = picture->Sequences().size();
    std::optional<bool> first;
    ASSERT_TRUE(RunUntil([&] {
      if (!first && worker->Sequences().size() == i + 1) {
        first = picture->Sequences().size() == shown;
      }
      return first.has_value();
    }));
    EXPECT_TRUE(*first) << "the picture came first, and waits all the same";
    Settle();
  }
  EXPECT_NEAR(static_cast<double>(picture->Sequences().size()), 10, 1);
}

TEST_F(ServerStreamTest, ASlowReaderWithDropOldestGetsTheNewestAndAGapForTheRest) {
  StartServer();
  const auto slow = Stalled(v1::QUEUE_POLICY_DROP_OLDEST, 10);
  for (int i = 0; i < 500; ++i) PublishMotion(4000);
  EXPECT_GT(server_->statistics().ticks_dropped, 100u);
  slow->Read();
  ASSERT_TRUE(RunUntil([&] {
    const auto sequences = slow->Sequences();
    return !sequences.empty() && sequences.back() == 500;
  }));
  // Every tick is either there or inside a Gap that stands in its place.
  std::uint64_t next = 1;
  std::uint64_t missing = 0;
  for (const auto& message : slow->messages) {
    if (message.has_gap()) {
      EXPECT_EQ(message.gap().reason(), v1::Gap::REASON_QUEUE_FULL);
      EXPECT_EQ(message.gap().from_sequence(), next);
      missing += message.gap().to_sequence() - next + 1;
      next = message.gap().to_sequence() + 1;
    } else if (message.has_tick() && !message.tick().snapshot()) {
      EXPECT_EQ(message.tick().sequence(), next);
      ++next;
    }
  }
  EXPECT_EQ(next, 501u);
  EXPECT_EQ(missing, server_->statistics().ticks_dropped);
}

TEST_F(ServerStreamTest, ASlowReaderWithLatestGetsTheNewestNext) {
  StartServer();
  const auto slow = Stalled(v1::QUEUE_POLICY_LATEST, 0);
  for (int i = 0; i < 500; ++i) PublishMotion(4000);
  slow->Read();
  ASSERT_TRUE(RunUntil([&] {
    const auto sequences = slow->Sequences();
    return !sequences.empty() && sequences.back() == 500;
  }));
  // Ticks that the kernel had taken before it was full, then the last.
  const auto sequences = slow->Sequences();
  EXPECT_LT(sequences.size(), 200u);
  EXPECT_EQ(sequences[sequences.size() - 2], sequences.size() - 1);
}

TEST_F(ServerStreamTest, ASlowReaderWithReliableIsEndedWithTheReason) {
  StartServer();
  const auto slow = Stalled(v1::QUEUE_POLICY_RELIABLE, 10);
  for (int i = 0; i < 500; ++i) PublishMotion(4000);
  slow->Read();
  ASSERT_TRUE(RunUntil([&] { return slow->closed.has_value(); }));
  ASSERT_TRUE(slow->messages.back().has_goodbye());
  EXPECT_NE(slow->messages.back().goodbye().reason().find("too slowly"), std::string::npos);
  const auto sequences = slow->Sequences();
  EXPECT_EQ(sequences, Range(1, sequences.size()));  // No hole up to its end.
}

TEST_F(ServerStreamTest, AStalledReaderDelaysNobodyAndItsTicksAreShared) {
  StartServer();
  const auto slow = Stalled(v1::QUEUE_POLICY_DROP_OLDEST, 1000);
  const auto healthy = Subscribed(Subscribe());
  for (std::uint64_t i = 1; i <= 300; ++i) {
    PublishMotion(4000);
    ASSERT_TRUE(RunUntil([&] { return healthy->Sequences().size() == i; })) << i;
  }
  EXPECT_EQ(healthy->Count(v1::Envelope::kGap), 0u);
}

TEST_F(ServerStreamTest, ResumeContinuesWithoutAHole) {
  StartServer();
  for (int i = 0; i < 50; ++i) PublishMotion();
  const auto client = Subscribed(ResumeFrom(11, server_->epoch()));
  for (int i = 0; i < 5; ++i) PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 45; }));
  EXPECT_EQ(client->Sequences(), Range(11, 55));
  EXPECT_EQ(client->Count(v1::Envelope::kGap), 0u);
  EXPECT_EQ(client->Find(v1::Envelope::kSubscribed)->subscribed().first_sequence(), 11u);
  EXPECT_TRUE(client->Find(v1::Envelope::kTick)->tick().snapshot());
}

TEST_F(ServerStreamTest, ResumeOfWhatTheRingHasPassedBeginsWithAGap) {
  ServerOptions options = Options();
  options.ring_s = 0.2;  // 20 ticks at 100 Hz.
  StartServer(options);
  for (int i = 0; i < 50; ++i) PublishMotion();
  const auto client = Subscribed(ResumeFrom(11, server_->epoch()));
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 20; }));
  EXPECT_EQ(client->Sequences(), Range(31, 50));
  const v1::Gap& gap = client->Find(v1::Envelope::kGap)->gap();
  EXPECT_EQ(gap.from_sequence(), 11u);
  EXPECT_EQ(gap.to_sequence(), 30u);
  EXPECT_EQ(gap.reason(), v1::Gap::REASON_RING_PASSED);
}

TEST_F(ServerStreamTest, ResumeIntoANewEpochSaysSo) {
  StartServer();
  PublishMotion();
  const auto client = Subscribed(ResumeFrom(400, server_->epoch() + 1));
  PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 1; }));
  EXPECT_EQ(client->Sequences(), Range(2, 2));
  ASSERT_NE(client->Find(v1::Envelope::kGap), nullptr);
  EXPECT_EQ(client->Find(v1::Envelope::kGap)->gap().reason(), v1::Gap::REASON_NEW_EPOCH);
}

TEST_F(ServerStreamTest, RefillBringsBackWhatTheRingHoldsAndAGapForTheRest) {
  ServerOptions options = Options();
  options.ring_s = 0.2;
  StartServer(options);
  const auto client = Subscribed(Subscribe());
  for (int i = 0; i < 50; ++i) PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 50; }));
  client->messages.clear();
  v1::Envelope refill;
  refill.mutable_refill()->set_from_sequence(25);
  refill.mutable_refill()->set_to_sequence(35);
  client->Send(refill);
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 5; }));
  EXPECT_EQ(client->Sequences(), Range(31, 35));
  EXPECT_TRUE(client->messages.back().tick().refilled());
  const v1::Gap& gap = client->Find(v1::Envelope::kGap)->gap();
  EXPECT_EQ(gap.from_sequence(), 25u);
  EXPECT_EQ(gap.to_sequence(), 30u);
  EXPECT_EQ(gap.reason(), v1::Gap::REASON_RING_PASSED);
}

TEST_F(ServerStreamTest, ATickNearTheLimitPasses) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  PublishMotion((1u << 20) - 200);
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 1; }));
  EXPECT_EQ(server_->statistics().channels_left_out, 0u);
}

TEST_F(ServerStreamTest, DrainingSendsWhatWaitsAndThenGoodbyeWithTheReason) {
  StartServer();
  auto slow = Connect();
  slow->Send(Hello());
  slow->Send(Subscribe(v1::QUEUE_POLICY_RELIABLE, 100));
  ASSERT_TRUE(RunUntil(
      [&] { return server_->sessions().size() == 1 && !server_->sessions()[0].policy.empty(); }));
  for (int i = 0; i < 60; ++i) PublishMotion(50'000);
  EXPECT_GT(server_->sessions().at(0).queue_ticks, 10u) << "more than the kernel takes";
  bool drained = false;
  server_->Drain("restarting after an update", [&] { drained = true; });
  Settle();
  EXPECT_FALSE(drained);
  slow->Read();
  ASSERT_TRUE(RunUntil([&] { return slow->closed.has_value(); }));
  EXPECT_EQ(slow->Sequences().size(), 60u);
  EXPECT_EQ(slow->messages.back().goodbye().reason(), "restarting after an update");
  slow.reset();
  EXPECT_TRUE(RunUntil([&] { return drained; }));
}

TEST_F(ServerStreamTest, WithoutSessionsDrainingIsDoneAtOnce) {
  StartServer();
  bool drained = false;
  server_->Drain("end", [&] { drained = true; });
  EXPECT_FALSE(drained) << "not from within the call";
  Settle();
  EXPECT_TRUE(drained);
}

}  // namespace
}  // namespace footing::transport
