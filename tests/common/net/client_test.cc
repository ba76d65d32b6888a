#include <numeric>

#include "tests/common/net/client_fixture.h"

namespace footing::transport {
namespace {

TEST(OnServersClock, TheOffsetCountsBetweenHostsOnly) {
  const Address unix_address = *ParseAddress("unix:/a"), tcp = *ParseAddress("tcp:127.0.0.1:7000");
  const std::int64_t far_ns = 3'600'000'000'000;
  EXPECT_EQ(OnServersClock(unix_address, {}, 100), 100);
  EXPECT_EQ(OnServersClock(tcp, {}, 100), 0);
  EXPECT_EQ(OnServersClock(tcp, {true, far_ns, 0}, 100), far_ns + 100);
  EXPECT_EQ(OnServersClock(tcp, {true, -far_ns, 0}, 100), 100 - far_ns);
  EXPECT_EQ(OnServersClock(tcp, {true, 1'800'000, 0}, 100), 100);  // As seen on a busy host.
}

TEST_F(ClientTest, BeforeItsServerItSaysWhatItWaitsForAndThenConnects) {
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntil([&] { return !states_.empty(); }));
  EXPECT_EQ(states_[0].first, LinkState::kConnecting);
  EXPECT_EQ(states_[0].second, "cannot connect to " + UnixAddress().Text() + ": no such file");
  StartServer();
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  PublishMotion();
  EXPECT_TRUE(RunUntil([&] { return sequences_.size() == 1; }));
  EXPECT_EQ(snapshots_.size(), 1u);
}

TEST_F(ClientTest, AfterALostConnectionItResumesWithoutAHole) {
  ServerOptions options = Options();
  options.ping_interval_s = 0.01;
  StartServer(options);
  StartClient(ClientOn(server_->ListeningOn(1)));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 10; ++i) PublishMotion();
    const int before = welcomes_;
    ASSERT_TRUE(RunUntil([&] {
      if (welcomes_ == before) {
        now_ns_ += 11'000'000'000;  // The server believes the client dead and ends the session.
        PublishMotion();
      }
      return welcomes_ > before && client_->state() == LinkState::kLive;
    }));
  }
  const std::uint64_t last = PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return !sequences_.empty() && sequences_.back() == last; }));
  std::vector<std::uint64_t> all(last);
  std::iota(all.begin(), all.end(), 1);
  EXPECT_EQ(sequences_, all);
  EXPECT_TRUE(gaps_.empty());
}

TEST_F(ClientTest, AServerStartedAnewIsToldByAGap) {
  StartServer();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return sequences_.size() == 1; }));
  server_->Stop("restart");
  server_.reset();
  ASSERT_TRUE(RunUntilState(LinkState::kConnecting));
  StartServer();
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  ASSERT_TRUE(RunUntil([&] { return gaps_.size() == 1; }));
  EXPECT_EQ(gaps_[0].reason(), v1::Gap::REASON_NEW_EPOCH);
  EXPECT_EQ(welcomes_, 2);
}

TEST_F(ClientTest, ARestartIsNotForgottenWhenTheFirstConnectionToItBreaks) {
  StartServer();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  PublishMotion();
  ASSERT_TRUE(RunUntil([&] { return sequences_.size() == 1; }));
  server_->Stop("restart");
  server_.reset();
  {
    // Welcomes the client, and is gone before that subscribes.
    std::vector<std::unique_ptr<TestClient>> broken;
    auto listener = Listener::Open(io_, UnixAddress(), [&](Socket socket) {
      broken.push_back(std::make_unique<TestClient>(std::move(socket)));
      v1::Envelope welcome;
      welcome.mutable_welcome()->set_server_id("restarted");
      welcome.mutable_welcome()->set_epoch(77);
      broken.back()->Send(welcome);
    });
    ASSERT_TRUE(listener.ok());
    ASSERT_TRUE(RunUntil([&] { return welcomes_ > 1; }));
  }
  StartServer();
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  ASSERT_TRUE(RunUntil([&] { return gaps_.size() == 1; }));
  EXPECT_EQ(gaps_[0].reason(), v1::Gap::REASON_NEW_EPOCH);
}

TEST_F(ClientTest, TheServersGoodbyeIsPassedOn) {
  StartServer();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  server_->Stop("out of coffee");
  ASSERT_TRUE(RunUntilState(LinkState::kConnecting));
  EXPECT_NE(states_.back().second.find("out of coffee"), std::string::npos);
  // Nor is it forgotten when the next dial fails.
  EXPECT_TRUE(RunUntil([&] {
    return states_.back().second.ends_with("no such file; the last one said: out of coffee");
  })) << states_.back().second;
}

TEST_F(ClientTest, ARefusalIsAStateOfItsOwnWithTheServersWords) {
  StartServer();
  ClientOptions options = ClientOn(server_->ListeningOn(1));
  options.role = v1::ROLE_ADMIN;
  StartClient(options);
  ASSERT_TRUE(RunUntilState(LinkState::kRefused));
  EXPECT_NE(states_.back().second.find("Unix socket"), std::string::npos);
}

TEST_F(ClientTest, SilenceIsStaleThenDead) {
  // Accepts and welcomes, then never says anything more.
  std::vector<std::unique_ptr<TestClient>> silent;
  auto listener = Listener::Open(io_, UnixAddress(), [&](Socket socket) {
    silent.push_back(std::make_unique<TestClient>(std::move(socket)));
    v1::Envelope welcome;
    welcome.mutable_welcome()->set_server_id("silent");
    silent.back()->Send(welcome);
    v1::Envelope subscribed;
    subscribed.mutable_subscribed();
    silent.back()->Send(subscribed);
    silent.back()->Read();
  });
  ASSERT_TRUE(listener.ok());
  std::int64_t now_ns = 0;
  client_now_ns_ = [&] { return now_ns; };
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  now_ns += 3'100'000'000;
  ASSERT_TRUE(RunUntilState(LinkState::kStale));
  now_ns += 7'000'000'000;
  ASSERT_TRUE(RunUntil([&] { return silent.size() == 2; }));  // It dials again.
}

TEST_F(ClientTest, MissingTicksCanBeAskedFor) {
  StartServer();
  for (int i = 0; i < 5; ++i) PublishMotion();
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntilState(LinkState::kLive));
  client_->Refill(2, 4);
  ASSERT_TRUE(RunUntil([&] { return sequences_.size() == 3; }));
  EXPECT_EQ(sequences_, (std::vector<std::uint64_t>{2, 3, 4}));
}

TEST_F(ClientTest, TheServersClockIsFoundWithinTheStatedUncertainty) {
  // The server's clock is the client's, 1 h ahead.
  constexpr std::int64_t kAhead = 3'600'000'000'000;
  ServerOptions options = Options();
  StartServer(options);
  server_.reset();
  options.now_ns = [] { return clock::MonotonicNs() + kAhead; };
  server_ = std::make_unique<Server>(io_, options, ServerHandlers());
  ASSERT_TRUE(server_->Listen(UnixAddress()).ok());
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntil([&] { return client_->clock().valid; }));
  const ClockOffset offset = client_->clock();
  EXPECT_GT(offset.uncertainty_ns, 0);
  EXPECT_LE(std::llabs(offset.offset_ns - kAhead), offset.uncertainty_ns);
}

TEST_F(ClientTest, TheClockIsKnownBeforeWhatTheRingHolds) {
  constexpr std::int64_t kAhead = 3'600'000'000'000;
  StartServer();
  server_.reset();
  ServerOptions options = Options();
  options.now_ns = [] { return clock::MonotonicNs() + kAhead; };
  server_ = std::make_unique<Server>(io_, options, ServerHandlers());
  ASSERT_TRUE(server_->Listen(UnixAddress()).ok());
  for (int i = 0; i < 2000; ++i) PublishMotion(2000);
  std::optional<ClockOffset> at_first_tick;
  ClientHandlers handlers;
  handlers.on_tick = [&](const v1::Tick&) {
    if (!at_first_tick) at_first_tick = client_->clock();
  };
  ClientOptions wish = ClientOn(UnixAddress());
  wish.from_ring_start = true;
  client_ = std::make_unique<Client>(io_, wish, handlers);
  client_->Start();
  ASSERT_TRUE(RunUntil([&] { return at_first_tick.has_value(); }));
  ASSERT_TRUE(at_first_tick->valid);
  EXPECT_LE(std::llabs(at_first_tick->offset_ns - kAhead), at_first_tick->uncertainty_ns);
}

TEST_F(ClientTest, WhatTheRingNoLongerHoldsIsNotMissedByWhoAsksForAllThatItHolds) {
  ServerOptions options = Options();
  options.ring_s = 0.05;  // 5 ticks.
  StartServer(options);
  for (int i = 0; i < 20; ++i) PublishMotion();
  ClientOptions wish = ClientOn(UnixAddress());
  wish.from_ring_start = true;
  StartClient(wish);
  ASSERT_TRUE(RunUntil([&] { return sequences_.size() == 5; }));
  EXPECT_EQ(sequences_.front(), 16u);
  EXPECT_TRUE(gaps_.empty());
}

TEST_F(ClientTest, AServerThatTalksNonsenseIsLeftAndTriedAgain) {
  std::vector<std::unique_ptr<TestClient>> accepted;
  auto listener = Listener::Open(io_, UnixAddress(), [&](Socket socket) {
    accepted.push_back(std::make_unique<TestClient>(std::move(socket)));
    accepted.back()->connection->Send("\xff\xff\xff");
    accepted.back()->Read();
  });
  ASSERT_TRUE(listener.ok());
  StartClient(ClientOn(UnixAddress()));
  ASSERT_TRUE(RunUntil([&] { return accepted.size() == 3; }));
  EXPECT_NE(states_.back().second.find("not a message of Footing's protocol"), std::string::npos);
}

TEST_F(ClientTest, StoppedInsideItsOwnHandlerItIsQuiet) {
  StartServer();
  ClientHandlers handlers;
  int ticks = 0;
  handlers.on_tick = [&](const v1::Tick&) {
    ++ticks;
    client_.reset();
  };
  client_ = std::make_unique<Client>(io_, ClientOn(UnixAddress()), handlers);
  client_->Start();
  ASSERT_TRUE(RunUntil([&] { return client_ == nullptr; }));
  PublishMotion();
  Settle();
  EXPECT_EQ(ticks, 1);
}

}  // namespace
}  // namespace footing::transport
