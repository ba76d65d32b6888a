#include "clients/relay/edge.h"

#include <cstdint>
#include <limits>

#include "tests/clients/relay/edge_fixture.h"

/// With real brokers, publishers and viewers: tests/scenarios/relay.py.
namespace footing::relay {
namespace {

TEST_F(EdgeTest, ServesInTheServersPlaceWithItsEpochSequencesTimesAndState) {
  ASSERT_TRUE(Serve(500, "a"));
  EXPECT_EQ(viewed_.welcomes[0].server_id(), "footingd");
  EXPECT_EQ(viewed_.welcomes[0].epoch(), 77u);
  EXPECT_EQ(viewed_.welcomes[0].channels_size(), 3);
  EXPECT_EQ(viewed_.snapshots[0].sequence(), 500u);
  EXPECT_EQ(viewed_.state, "a");
  ASSERT_TRUE(Arrives(501));
  const v1::Tick& tick = viewed_.ticks[0];
  EXPECT_EQ(tick.epoch(), 77u);
  EXPECT_EQ(tick.host_ns(), 501 * kTickNs);
  EXPECT_EQ(tick.motion().samples(0).device(), 501u);
  EXPECT_EQ(viewer_->clock().offset_ns, ahead_ns_);
}

TEST_F(EdgeTest, ListensOnlyOnceTheServersStateIsKnown) {
  answers_ = 0;
  Stand(500, "a");
  Start();
  ASSERT_TRUE(RunUntil([&] { return asked_ >= 2; }));
  EXPECT_FALSE(edge_->report().serving);
  Deliver(TickOf(501));
  Settle();
  EXPECT_EQ(edge_->report().ticks, 0u);
  answers_ = 1;
  EXPECT_TRUE(RunUntil([&] { return edge_->report().serving; }));
}

TEST_F(EdgeTest, TicksAreLeftOutByTheRate) {
  ASSERT_TRUE(Serve(0, "a", 25));
  for (std::uint64_t sequence = 1; sequence <= 100; ++sequence) Publish(sequence);
  ASSERT_TRUE(RunUntil([&] { return edge_->report().ticks == 100; }));
  Settle();
  EXPECT_EQ(viewed_.ticks.size(), 25u);
  EXPECT_TRUE(viewed_.gaps.empty());  // On purpose.
  EXPECT_EQ(edge_->report().left_out, 75u);
  EXPECT_EQ(edge_->report().missing, 0u);
}

TEST_F(EdgeTest, AHoleIsAGapAndTheStateThatWasLostInItIsFetched) {
  ASSERT_TRUE(Serve(500, "a"));
  RunFor(1);
  ASSERT_TRUE(Arrives(501));
  Lose(502, "b");
  ASSERT_TRUE(Arrives(503));
  ASSERT_EQ(viewed_.gaps.size(), 1u);
  EXPECT_EQ(viewed_.gaps[0].from_sequence(), 502u);
  EXPECT_EQ(viewed_.gaps[0].to_sequence(), 502u);
  EXPECT_EQ(edge_->report().missing, 1u);
  ASSERT_TRUE(Arrives(504));
  EXPECT_EQ(viewed_.state, "b");
}

TEST_F(EdgeTest, TheStateThatWasLostInASecondHoleIsFetchedAsWell) {
  ASSERT_TRUE(Serve(500, "a"));
  RunFor(1);
  Lose(501, "b");
  ASSERT_TRUE(Arrives(502));
  Lose(503, "c");  // Right behind the first: not requested at once.
  ASSERT_TRUE(Arrives(504));
  RunFor(1.5);
  ASSERT_TRUE(Arrives(505));
  EXPECT_EQ(viewed_.state, "c");
}

TEST_F(EdgeTest, AStateWhoseAnswerIsLostIsRequestedAgain) {
  ASSERT_TRUE(Serve(500, "a"));
  RunFor(1);
  answers_ = 0;
  Lose(501, "b");
  ASSERT_TRUE(Arrives(502));
  answers_ = 1 << 20;
  RunFor(1.5);
  ASSERT_TRUE(Arrives(503));
  EXPECT_EQ(viewed_.state, "b");
  const int asked = asked_;
  RunFor(2);
  EXPECT_EQ(asked_, asked);  // It has what it wanted.
}

TEST_F(EdgeTest, ASnapshotThatIsOlderThanATickTakesNoStateBack) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  RunFor(1);
  // Another publisher of the same server, which is behind, answers.
  Deliver(TickOf(503, "new"));
  ASSERT_TRUE(RunUntil([&] { return viewed_.Has(503); }));
  ASSERT_TRUE(RunUntil([&] { return asked_ >= 2; }));
  Settle();
  Deliver(TickOf(504));
  ASSERT_TRUE(RunUntil([&] { return viewed_.Has(504); }));
  EXPECT_EQ(viewed_.state, "new");
}

TEST_F(EdgeTest, ASnapshotThatIsOlderThanTheFirstTakesNoStateBack) {
  ASSERT_TRUE(Serve(500, "new"));
  RunFor(1);
  Stand(400, "old");  // From another publisher, which is behind.
  Deliver(TickOf(502));
  ASSERT_TRUE(RunUntil([&] { return asked_ >= 2; }));
  Settle();
  Deliver(TickOf(503));
  ASSERT_TRUE(RunUntil([&] { return viewed_.Has(503); }));
  EXPECT_EQ(viewed_.state, "new");
}

TEST_F(EdgeTest, ATickThatComesTwiceGoesOnOnce) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  Publish(501);
  ASSERT_TRUE(Arrives(502));
  EXPECT_EQ(viewed_.ticks.size(), 2u);
  EXPECT_EQ(edge_->report().missing, 0u);
}

TEST_F(EdgeTest, AServerThatStartsAgainSendsViewersToItsNewEpochAndClock) {
  trip_ns_ = 100'000;
  ASSERT_TRUE(Serve(500, "a"));
  RunFor(3);
  ASSERT_TRUE(Arrives(501));
  // Another host in its place, whose answers take longer.
  welcome_.set_epoch(78);
  ahead_ns_ = -900'000'000'000;
  trip_ns_ = 400'000;
  Publish(3, "b");
  ASSERT_TRUE(RunUntil([&] { return viewed_.welcomes.size() == 2; }));
  EXPECT_TRUE(viewed_.HasLine("footingd was started again"));
  EXPECT_EQ(viewed_.welcomes[1].epoch(), 78u);
  ASSERT_TRUE(Arrives(4));
  EXPECT_EQ(viewed_.state, "b");
  EXPECT_NEAR(static_cast<double>(viewer_->clock().offset_ns), static_cast<double>(ahead_ns_), 1e6);
  Publish(5);
  ASSERT_TRUE(RunUntil([&] { return viewed_.Has(5); }));
  EXPECT_EQ(edge_->report().missing, 0u);
  EXPECT_FALSE(broken_);
}

TEST_F(EdgeTest, SilenceSendsViewersAwayAndTheServersReturnBringsThemBack) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  answers_ = 0;
  ASSERT_TRUE(RunUntil([&] { return viewed_.HasLine("nothing comes from footingd of lab"); }));
  RunFor(2);
  EXPECT_FALSE(edge_->report().serving);
  answers_ = 1 << 20;
  Stand(900, "b");
  ASSERT_TRUE(RunUntil([&] { return viewed_.welcomes.size() == 2; }));
  ASSERT_TRUE(Arrives(901));
  EXPECT_EQ(viewed_.state, "b");
  ASSERT_EQ(viewed_.gaps.size(), 1u);
  EXPECT_EQ(viewed_.gaps[0].from_sequence(), 502u);
  EXPECT_EQ(viewed_.gaps[0].to_sequence(), 900u);
  EXPECT_EQ(edge_->report().missing, 399u);
}

TEST_F(EdgeTest, AForgedSequenceDoesNotMakeItDeafForGood) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  v1::Tick forged = TickOf(502);
  forged.set_sequence(std::uint64_t{1} << 60);
  Deliver(forged);
  std::uint64_t sequence = 501;
  const std::int64_t end_ns = clock::MonotonicNs() + 8'000'000'000;
  while (clock::MonotonicNs() < end_ns) {
    Publish(++sequence);
    RunFor(0.1);
  }
  EXPECT_TRUE(RunUntil([&] { return viewed_.Has(sequence); }));
}

TEST_F(EdgeTest, NumbersThatCannotBeAreNoSignOfLife) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  answers_ = 0;
  for (int i = 0; i < 50; ++i) {
    v1::Tick forged = TickOf(502);
    forged.set_sequence(std::numeric_limits<std::uint64_t>::max());
    Deliver(forged);
    RunFor(0.1);
  }
  EXPECT_FALSE(edge_->report().serving);
}

TEST_F(EdgeTest, ItsOwnPauseIsNotTheServersSilence) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  clock::SleepUntil(clock::MonotonicNs() + 5'000'000'000);  // As after SIGSTOP.
  ASSERT_TRUE(Arrives(502));
  EXPECT_TRUE(viewed_.gaps.empty());
  EXPECT_EQ(viewed_.welcomes.size(), 1u);
}

TEST_F(EdgeTest, ABrokenLinkToNatsIsAGapForViewersWhoStay) {
  ASSERT_TRUE(Serve(500, "a"));
  ASSERT_TRUE(Arrives(501));
  RunFor(1);
  nats_.Break();
  ASSERT_TRUE(RunUntil([&] { return !edge_->report().nats_up; }));
  Lose(502, "b");
  Lose(503);
  ASSERT_TRUE(RunUntil([&] { return edge_->report().nats_up; }));
  ASSERT_TRUE(Arrives(504));
  ASSERT_TRUE(Arrives(505));
  EXPECT_EQ(viewed_.state, "b");
  EXPECT_EQ(viewed_.welcomes.size(), 1u);
  ASSERT_EQ(viewed_.gaps.size(), 1u);
  EXPECT_EQ(viewed_.gaps[0].from_sequence(), 502u);
  EXPECT_EQ(viewed_.gaps[0].to_sequence(), 503u);
}

TEST_F(EdgeTest, AViewerWhoComesLaterGetsTheNewestState) {
  ASSERT_TRUE(Serve(500, "a"));
  Publish(501, "b");
  ASSERT_TRUE(RunUntil([&] { return viewed_.Has(501); }));
  viewer_.reset();
  viewed_ = {};
  View();
  ASSERT_TRUE(RunUntil([&] { return !viewed_.snapshots.empty(); }));
  EXPECT_EQ(viewed_.snapshots[0].sequence(), 501u);
  EXPECT_EQ(viewed_.state, "b");
  EXPECT_EQ(edge_->report().accepted, 2u);
}

TEST_F(EdgeTest, WhatAWelcomeSaysIsServedOnlyAsFarAsItCanBe) {
  welcome_.clear_channels();
  for (int i = 0; i < 20'000; ++i) welcome_.add_channels(i % 2 == 0 ? "status" : "unheard of");
  std::string version(63, 'v');
  welcome_.set_version(version + "\xc3\xa4");  // Cut within a letter it would be no text.
  welcome_.mutable_limits()->set_tick_rate_hz(std::numeric_limits<double>::quiet_NaN());
  ASSERT_TRUE(Serve(500, "a"));
  EXPECT_EQ(viewed_.welcomes[0].channels_size(), 1);
  EXPECT_EQ(viewed_.welcomes[0].version(), version + " relayed");
}

TEST_F(EdgeTest, CommandsAreForTheServerItself) {
  ASSERT_TRUE(Serve(500, "a"));
  std::optional<v1::CommandResult> result;
  v1::Command command;
  command.mutable_tare();
  viewer_->Send(command, [&](const v1::CommandResult& answer) { result = answer; });
  ASSERT_TRUE(RunUntil([&] { return result.has_value(); }));
  EXPECT_FALSE(result->ok());
}

TEST_F(EdgeTest, SaysGoodbyeWhenItIsDrained) {
  ASSERT_TRUE(Serve(500, "a"));
  bool drained = false;
  edge_->Drain("the edge ends", [&] { drained = true; });
  EXPECT_TRUE(RunUntil([&] { return drained; }));
  EXPECT_TRUE(RunUntil([&] { return viewed_.HasLine("the edge ends"); }));
}

}  // namespace
}  // namespace footing::relay
