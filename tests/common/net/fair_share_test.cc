// What keeps one session from taking the loop's time from all others.
#include <sys/epoll.h>
#include <unistd.h>

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>

#include "common/runtime/clock.h"
#include "common/net/framing.h"
#include "common/net/token_bucket.h"
#include "common/net/turn_queue.h"
#include "common/base/units.h"
#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

namespace asio = boost::asio;

constexpr std::int64_t kSecondNs = kNanosecondsPerSecond;

TEST(TokenBucket, TheBurstAtOnceThenTheRate) {
  TokenBucket bucket(10, 3);
  std::int64_t now_ns = kSecondNs;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(bucket.HasOne(now_ns));
    bucket.Charge(1);
  }
  EXPECT_FALSE(bucket.HasOne(now_ns));
  EXPECT_NEAR(static_cast<double>(bucket.WaitNs(now_ns, 2)), 0.2e9, 2);  // 2 tokens at 10 a second.
  now_ns += kSecondNs / 10 + 1;
  EXPECT_TRUE(bucket.HasOne(now_ns));
  now_ns += 100 * kSecondNs;
  EXPECT_TRUE(bucket.HasOne(now_ns));
  bucket.Charge(3);  // A long pause has filled it to the burst, no further.
  EXPECT_FALSE(bucket.HasOne(now_ns));
}

TEST(TokenBucket, ADebtIsPaidFirst) {
  TokenBucket bucket(10, 5);
  EXPECT_TRUE(bucket.HasOne(kSecondNs));
  bucket.Charge(15);
  EXPECT_FALSE(bucket.HasOne(kSecondNs + kSecondNs));
  EXPECT_TRUE(bucket.HasOne(kSecondNs + kSecondNs * 11 / 10 + 1));  // -10 + 11.
}

TEST(TokenBucket, WithoutARateNothingIsLimited) {
  TokenBucket bucket;
  bucket.Charge(1e9);
  EXPECT_TRUE(bucket.HasOne(kSecondNs));
  EXPECT_EQ(bucket.WaitNs(kSecondNs, 1), 0);
}

class FairShareTest : public ServerFixture {};

TEST_F(FairShareTest, ATimerComesThroughThoughTheLineNeverEnds) {
  const auto turns = std::make_shared<TurnQueue>(io_.get_executor());
  int first = 0, second = 0;
  bool fired = false;
  const auto over = [&] { return fired && first > 10 && second > 10; };
  const auto work = [&over](int& count) {
    const std::int64_t until_ns = clock::MonotonicNs() + 50'000;
    while (clock::MonotonicNs() < until_ns) {
    }
    ++count;
    return !over();
  };
  turns->Add([&] { return work(first); });
  turns->Add([&] { return work(second); });
  asio::steady_timer timer(io_, std::chrono::milliseconds(20));
  timer.async_wait([&](const boost::system::error_code&) { fired = true; });
  EXPECT_TRUE(RunUntil([&] { return over(); }));
  Settle();
  EXPECT_LE(std::abs(first - second), 1) << first << " against " << second;
}

/// A connection with a budget of 10 messages and 200 more a second, and its raw other end.
class BudgetTest : public IoFixture {
 protected:
  void Connect(bool in_turns) {
    asio::local::stream_protocol::socket near(io_);
    asio::local::connect_pair(near, far_);
    FramedLimits limits;
    limits.input = {200, 10, 0, 0};
    FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view) { ++frames_; };
    handlers.on_close = [](const std::string&) {};
    handlers.on_slowed = [this](double wait_s) { waited_s_ += wait_s; };
    SharedLoop loop;
    if (in_turns) loop.turns = std::make_shared<TurnQueue>(io_.get_executor());
    connection_.emplace(Socket(std::move(near)), limits, std::move(handlers), loop);
    connection_->Start();
  }

  asio::local::stream_protocol::socket far_{io_};
  std::optional<FramedConnection> connection_;
  int frames_ = 0;
  double waited_s_ = 0;
};

TEST_F(BudgetTest, WhoSendsTooMuchWaitsAndLosesNothing) {
  for (const bool in_turns : {false, true}) {
    frames_ = 0;
    waited_s_ = 0;
    far_ = asio::local::stream_protocol::socket(io_);
    Connect(in_turns);
    std::string bytes;
    for (int i = 0; i < 50; ++i) bytes += Frame("message");
    asio::write(far_, asio::buffer(bytes));
    ASSERT_TRUE(RunUntil([&] { return waited_s_ > 0; }));
    EXPECT_LT(frames_, 30);
    ASSERT_TRUE(RunUntil([&] { return frames_ == 50; }));
    EXPECT_GT(waited_s_,
              0.1);  // 40 over the burst, 8 in a turn, at 200 a second: 0.2 s less a turn.
  }
}

TEST_F(FairShareTest, AFloodingSessionIsSlowedAndInformedAndOthersAreServed) {
  StartServer();
  const auto flooding = Connect(1);
  flooding->Read();
  flooding->Send(Hello());
  ASSERT_TRUE(WaitFor(*flooding, v1::Envelope::kWelcome));
  v1::Envelope ping;
  ping.mutable_ping()->set_id(1);
  for (int i = 0; i < 300; ++i) flooding->Send(ping);
  ASSERT_TRUE(WaitFor(*flooding, v1::Envelope::kNotice));
  const v1::Notice notice = flooding->Find(v1::Envelope::kNotice)->notice();
  EXPECT_EQ(notice.kind(), v1::Notice::KIND_SLOWED);
  EXPECT_NE(notice.text(), "");
  EXPECT_EQ(notice.count(), 1u);

  const auto healthy = Subscribed(Subscribe());
  EXPECT_LT(flooding->Count(v1::Envelope::kPong), 200u) << "the flood went first";
  PublishMotion();
  EXPECT_TRUE(RunUntil([&] { return healthy->Sequences().size() == 1; }));
  EXPECT_EQ(healthy->Count(v1::Envelope::kNotice), 0u);
  EXPECT_GE(server_->statistics().slowed, 1u);
  ASSERT_EQ(overloads_.size(), 1u) << "one line in 10 s";
  EXPECT_NE(overloads_[0].find("(test)"), std::string::npos) << overloads_[0];
  // Slowed, not cut: each gets its answer in the end.
  EXPECT_TRUE(RunUntil([&] { return flooding->Count(v1::Envelope::kPong) == 300; }));
}

/// Which of two connections the kernel made readable first.
class FirstReadable {
 public:
  FirstReadable(int one, int two) {
    for (const int descriptor : {one, two}) {
      epoll_event event{.events = EPOLLIN, .data = {.fd = descriptor}};
      EXPECT_EQ(epoll_ctl(epoll_, EPOLL_CTL_ADD, descriptor, &event), 0);
    }
  }
  ~FirstReadable() { close(epoll_); }
  FirstReadable(const FirstReadable&) = delete;
  FirstReadable& operator=(const FirstReadable&) = delete;

  int Descriptor() const {
    epoll_event event{};
    return epoll_wait(epoll_, &event, 1, 0) == 1 ? event.data.fd : -1;
  }

 private:
  const int epoll_ = epoll_create1(EPOLL_CLOEXEC);
};

TEST_F(FairShareTest, WhoFloodsGetsItsTicksBehindAllOthers) {
  ServerOptions options = Options();
  options.ping_interval_s = 100;  // No ping comes between the ticks.
  StartServer(options);
  const auto flooding = Subscribed(Subscribe());
  const auto healthy = Subscribed(Subscribe());
  const int first = flooding->connection->native_handle();
  const int second = healthy->connection->native_handle();
  const FirstReadable readable(first, second);
  Settle();
  PublishMotion();
  EXPECT_EQ(readable.Descriptor(), first) << "in the order in which they came";

  v1::Envelope ping;
  ping.mutable_ping()->set_id(1);
  for (int i = 0; i < 200; ++i) flooding->Send(ping);
  ASSERT_TRUE(RunUntil([&] { return flooding->Count(v1::Envelope::kPong) == 200; }));
  ASSERT_GE(flooding->Count(v1::Envelope::kNotice), 1u);
  Settle();
  ASSERT_EQ(readable.Descriptor(), -1);
  PublishMotion();
  EXPECT_EQ(readable.Descriptor(), second);
  Settle();
  now_ns_ += 3 * kSecondNs;  // It has stopped.
  PublishMotion();
  EXPECT_EQ(readable.Descriptor(), first);
}

TEST_F(FairShareTest, ASubscribeCountsAsManyMessages) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  for (int i = 0; i < 20; ++i) client->Send(Subscribe());
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kNotice));
  EXPECT_LT(client->Count(v1::Envelope::kSubscribed), 10u);
}

TEST_F(FairShareTest, LateTicksAreCountedAndSaidToAllOnce) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  server_->NoteLateTicks(12);
  server_->NoteLateTicks(3);
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kNotice));
  Settle();
  EXPECT_EQ(client->Count(v1::Envelope::kNotice), 1u);
  EXPECT_EQ(client->Find(v1::Envelope::kNotice)->notice().kind(), v1::Notice::KIND_TICKS_LATE);
  EXPECT_EQ(client->Find(v1::Envelope::kNotice)->notice().count(), 12u);
  EXPECT_EQ(server_->statistics().late_ticks, 15u);
  ASSERT_EQ(overloads_.size(), 1u);
}

TEST_F(FairShareTest, TicksThatWereLeftOutAreAHoleInTheSequenceWithAGap) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  const std::uint64_t before = server_->Publish(now_ns_, {});
  server_->NoteLateTicks(12);
  server_->NoteLateTicks(3);
  const std::uint64_t after = server_->Publish(now_ns_, {});
  EXPECT_EQ(after, before + 16);
  EXPECT_EQ(server_->Publish(now_ns_, {}), after + 1);
  ASSERT_TRUE(RunUntil([&] { return client->Sequences().size() == 3; }));
  const v1::Envelope* const gap = client->Find(v1::Envelope::kGap);
  ASSERT_NE(gap, nullptr);
  EXPECT_EQ(gap->gap().from_sequence(), before + 1);
  EXPECT_EQ(gap->gap().to_sequence(), after - 1);
  EXPECT_EQ(client->Count(v1::Envelope::kGap), 1u);
}

TEST_F(FairShareTest, AChannelTooLongForATickIsLoggedByItsName) {
  ServerOptions options = Options();
  options.max_message_out_bytes = 1000;
  StartServer(options);
  for (int i = 0; i < 3; ++i) server_->Publish(now_ns_, {{17, std::string(2000, 'x')}});
  ASSERT_EQ(overloads_.size(), 1u);
  EXPECT_NE(overloads_[0].find("channel motion was left out"), std::string::npos) << overloads_[0];
}

/// Share of the time for work that comes whenever nothing waits.
double MeasuredShare(const TurnPace& pace) {
  asio::io_context io;
  const auto turns = std::make_shared<TurnQueue>(io.get_executor(), pace);
  const std::int64_t begun_ns = clock::MonotonicNs();
  std::int64_t worked_ns = 0;
  int left = 40;
  std::function<void()> add = [&] {
    turns->Add([&] {
      const std::int64_t from_ns = clock::MonotonicNs();
      while (clock::MonotonicNs() < from_ns + 200'000) {
      }
      worked_ns += clock::MonotonicNs() - from_ns;
      // When the line is empty again, as that of a socket that takes no more for now.
      if (--left > 0) asio::post(io, add);
      return false;
    });
  };
  add();
  io.run();
  return static_cast<double>(worked_ns) / static_cast<double>(clock::MonotonicNs() - begun_ns);
}

TEST(TurnQueue, ASmallShareIsKeptAlsoByWorkThatComesWhenNothingWaits) {
  // A machine that stalls in the middle of the work makes the share of that run greater.
  double least = 1;
  for (int i = 0; i < 10 && least >= 0.3; ++i) {
    least = std::min(least, MeasuredShare({.share = 0.2, .rests_when_empty = true}));
  }
  EXPECT_LT(least, 0.3);
}

TEST_F(FairShareTest, TheWelcomeNamesTheLimits) {
  StartServer();
  const auto client = Connect();
  client->Read();
  client->Send(Hello());
  ASSERT_TRUE(WaitFor(*client, v1::Envelope::kWelcome));
  const v1::Limits& limits = client->Find(v1::Envelope::kWelcome)->welcome().limits();
  EXPECT_EQ(limits.max_messages_per_s(), 100);
  EXPECT_EQ(limits.max_message_burst(), 100u);
}

}  // namespace
}  // namespace footing::transport
