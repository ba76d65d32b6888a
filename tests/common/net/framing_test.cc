#include <fstream>
#include <optional>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>
#include <sys/epoll.h>
#include <unistd.h>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>

#include "common/base/units.h"
#include "common/net/framing.h"
#include "common/net/limits.h"
#include "common/net/turn_queue.h"
#include "common/runtime/clock.h"
#include "footing/v1/session.pb.h"
#include "tests/common/net/io_fixture.h"
#include "tests/common/net/server_fixture.h"

namespace footing::transport {
namespace {

class BadInputTest : public ServerFixture {
 protected:
  /// Writes raw bytes to the server and returns the client that reads what comes back.
  std::unique_ptr<TestClient> Throw(const std::string& bytes, std::size_t listener) {
    Socket socket = DialServer(listener);
    boost::asio::write(socket.plain(), boost::asio::buffer(bytes));
    auto client = std::make_unique<TestClient>(std::move(socket));
    client->Read();
    return client;
  }
  void ExpectRefusedAsBad(const std::string& bytes) {
    for (const std::size_t listener : {0u, 1u}) {
      const auto client = Throw(bytes, listener);
      ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
      const v1::Envelope* refused = client->Find(v1::Envelope::kRefused);
      ASSERT_NE(refused, nullptr);
      EXPECT_EQ(refused->refused().reason(), v1::Refused::REASON_BAD_MESSAGE);
      EXPECT_FALSE(refused->refused().message().empty());
    }
  }
};

TEST_F(BadInputTest, AnOversizedLengthIsRefusedBeforeItsBytesCome) {
  StartServer();
  ExpectRefusedAsBad(std::string("\x00\x00\x00\x10", 4));  // 256 MiB announced, nothing sent.
  ExpectRefusedAsBad("\xff\xff\xff\xff");
  ExpectRefusedAsBad(Frame(std::string((64u << 10) + 1, 'x')));
}

TEST_F(BadInputTest, ALengthThatIsNotLittleEndianIsExplained) {
  StartServer();
  const auto client = Throw(std::string("\x00\x00\x00\x10", 4), 1);
  ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
  const v1::Envelope* refused = client->Find(v1::Envelope::kRefused);
  ASSERT_NE(refused, nullptr);
  EXPECT_NE(refused->refused().message().find("four bytes, little-endian"), std::string::npos);
}

TEST_F(BadInputTest, GarbageIsRefused) {
  StartServer();
  ExpectRefusedAsBad("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ExpectRefusedAsBad(Frame("\xff\xff\xff\xff\xff"));
}

TEST_F(BadInputTest, ASessionThatDoesNotBeginWithHelloIsRefused) {
  StartServer();
  ExpectRefusedAsBad(Frame(Subscribe().SerializeAsString()));
  ExpectRefusedAsBad(Frame(""));
}

TEST_F(BadInputTest, NonsenseAfterHelloEndsThatSessionOnlyWithTheReason) {
  StartServer();
  const auto other = Subscribed(Subscribe());
  v1::Envelope tick;
  tick.mutable_tick()->set_sequence(1);
  v1::Envelope refill;
  refill.mutable_refill()->set_to_sequence(5);
  for (const std::string& nonsense :
       {Frame("\xff\xff\xff"), Frame(tick.SerializeAsString()), Frame(refill.SerializeAsString()),
        Frame(Hello().SerializeAsString())}) {
    const auto client = Throw(Frame(Hello().SerializeAsString()) + nonsense, 1);
    ASSERT_TRUE(RunUntil([&] { return client->closed.has_value(); }));
    ASSERT_TRUE(client->messages.back().has_goodbye());
    EXPECT_FALSE(client->messages.back().goodbye().reason().empty());
  }
  PublishMotion();
  EXPECT_TRUE(RunUntil([&] { return other->Sequences().size() == 1; }));
}

TEST_F(BadInputTest, AMessageOfALaterMinorVersionIsPassedOver) {
  StartServer();
  const auto client = Subscribed(Subscribe());
  client->connection->Send("\xa2\x06\x03xyz");  // Field 100 of Envelope, three bytes.
  PublishMotion();
  EXPECT_TRUE(RunUntil([&] { return client->Sequences().size() == 1; }));
  EXPECT_FALSE(client->closed.has_value());
}

TEST_F(BadInputTest, AConnectionCutAtAnyByteOfItsHelloDisturbsNobody) {
  StartServer();
  const auto other = Subscribed(Subscribe());
  const std::string bytes =
      Frame(Hello().SerializeAsString()) + Frame(Subscribe().SerializeAsString());
  for (std::size_t cut = 0; cut < bytes.size(); ++cut) {
    Socket socket = DialServer(cut % 2);
    boost::asio::write(socket.plain(), boost::asio::buffer(bytes.substr(0, cut)));
    socket.Close();
    PublishMotion();
  }
  EXPECT_TRUE(RunUntil([&] { return other->Sequences().size() == bytes.size(); }));
  EXPECT_TRUE(RunUntil([&] { return server_->statistics().sessions == 1; }));
}

TEST_F(BadInputTest, RandomBytesNeverStopTheServer) {
  StartServer();
  const auto other = Subscribed(Subscribe());
  std::mt19937 random(20);
  const std::string hello = Frame(Hello().SerializeAsString());
  const std::string subscribe = Frame(Subscribe().SerializeAsString());
  for (int round = 0; round < 200; ++round) {
    std::string bytes = hello + subscribe;
    for (int flips = 1 + round % 5; flips > 0; --flips) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    Socket socket = DialServer(random() % 2);
    boost::system::error_code ignored;  // The server may have ended it already.
    boost::asio::write(socket.plain(), boost::asio::buffer(bytes), ignored);
    PublishMotion();
  }
  EXPECT_TRUE(RunUntil([&] { return other->Sequences().size() == 200; }));
}

TEST_F(BadInputTest, NotANumberAsARateMeansEveryTick) {
  StartServer();
  v1::Envelope wish = Subscribe();
  wish.mutable_subscribe()->set_max_hz(std::numeric_limits<double>::quiet_NaN());
  const auto client = Subscribed(wish);
  EXPECT_EQ(client->Find(v1::Envelope::kSubscribed)->subscribed().max_hz(), 100);
}

}  // namespace

// Limits that keep one session from taking the loop's time from all others.
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

using Raw = asio::local::stream_protocol::socket;

class FramedConnectionTest : public IoFixture {
 protected:
  /// A connection under test, and the raw other end of it.
  void Connect(const FramedLimits& limits = {}) {
    Raw near(io_);
    asio::local::connect_pair(near, far_);
    far_.non_blocking(true);
    FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { frames_.emplace_back(payload); };
    handlers.on_close = [this](const std::string& reason) { closed_ = reason; };
    connection_.emplace(Socket(std::move(near)), limits, std::move(handlers));
    connection_->Start();
  }
  void WriteRaw(const std::string& bytes) { asio::write(far_, asio::buffer(bytes)); }
  /// Everything that can be read now, appended.
  void ReadRaw() {
    boost::system::error_code error;
    std::string piece(1 << 16, '\0');
    while (!error) {
      const std::size_t size = far_.read_some(asio::buffer(piece), error);
      received_.append(piece, 0, size);
    }
    if (error == asio::error::eof) end_seen_ = true;
  }

  Raw far_{io_};
  std::optional<FramedConnection> connection_;
  std::vector<std::string> frames_;
  std::optional<std::string> closed_;
  std::string received_;
  bool end_seen_ = false;
};

TEST_F(FramedConnectionTest, FramesPassBothWays) {
  Connect();
  WriteRaw(Frame("in 1") + Frame("in 2"));
  EXPECT_TRUE(connection_->Send("out"));
  EXPECT_TRUE(RunUntil([&] { return frames_.size() == 2; }));
  ReadRaw();
  EXPECT_EQ(frames_, (std::vector<std::string>{"in 1", "in 2"}));
  EXPECT_EQ(received_, Frame("out"));
}

TEST_F(FramedConnectionTest, AnOversizedLengthEndsTheConnectionWithBothNumbers) {
  Connect();
  WriteRaw(std::string("\x00\x00\x00\x10", 4));  // 256 MiB.
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_NE(closed_->find("268435456"), std::string::npos);
  EXPECT_NE(closed_->find("65536"), std::string::npos);
}

TEST_F(FramedConnectionTest, ATruncatedFrameIsToldFromACleanEnd) {
  Connect();
  WriteRaw("\x05");
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "the other side closed in the middle of a message");
  Raw fresh(io_);
  far_ = std::move(fresh);
  closed_.reset();
  Connect();
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "the other side closed the connection");
}

TEST_F(FramedConnectionTest, AFullQueueRefusesWithoutLosingWhatWaits) {
  FramedLimits limits;
  limits.max_queued_bytes = 100'000;
  Connect(limits);
  const std::string payload(10'000, 'p');
  std::size_t taken = 0;
  while (connection_->Send(payload)) ++taken;  // First the kernel's buffer fills, then the queue.
  EXPECT_LE(connection_->queued_bytes(), limits.max_queued_bytes);
  EXPECT_GT(connection_->queued_bytes(), limits.max_queued_bytes - payload.size());
  const std::size_t expected = taken * (payload.size() + kLengthBytes);
  EXPECT_TRUE(RunUntil([&] {
    ReadRaw();
    return received_.size() >= expected;
  }));
  EXPECT_EQ(received_.size(), expected);
  EXPECT_FALSE(closed_.has_value());
}

TEST_F(FramedConnectionTest, AFrameOverTheOutwardLimitIsRefused) {
  FramedLimits limits;
  limits.max_out_bytes = 10;
  Connect(limits);
  EXPECT_TRUE(connection_->Send(std::string(10, 'x')));
  EXPECT_FALSE(connection_->Send(std::string(11, 'x')));
}

TEST_F(FramedConnectionTest, TheLastWordArrivesThoughTheOtherSideStillTalks) {
  Connect();
  WriteRaw(Frame("talk") + "more that nobody reads");
  connection_->Finish("last", "told to go");
  EXPECT_TRUE(RunUntil([&] {
    ReadRaw();
    return end_seen_;
  }));
  EXPECT_EQ(received_, Frame("last"));
  far_.close();
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "told to go");
  EXPECT_TRUE(frames_.empty());
}

TEST_F(FramedConnectionTest, AnOtherSideThatNeverReadsDelaysTheEndByTheLingerOnly) {
  FramedLimits limits;
  limits.linger_s = 0.01;
  Connect(limits);
  while (connection_->Send(std::string(10'000, 'p'))) {
  }
  connection_->Finish("last", "too slow");
  ASSERT_TRUE(RunUntil([&] { return closed_.has_value(); }));
  EXPECT_EQ(*closed_, "too slow");
}

TEST_F(FramedConnectionTest, AfterCloseNoHandlerIsCalled) {
  Connect();
  WriteRaw(Frame("late"));
  connection_->Close();
  Settle();
  EXPECT_TRUE(frames_.empty());
  EXPECT_FALSE(closed_.has_value());
}

/// Frames that come out when `bytes` are fed in pieces of `piece` bytes.
struct Outcome {
  std::vector<std::string> frames;
  bool ok = true;
  std::size_t pending = 0;
};

Outcome FeedInPieces(const std::string& bytes, std::size_t piece, std::uint32_t max = 100) {
  FrameSplitter splitter(max);
  Outcome outcome;
  for (std::size_t at = 0; at < bytes.size() && outcome.ok; at += piece) {
    outcome.ok = splitter
                     .Feed(std::string_view(bytes).substr(at, piece),
                           [&](std::string_view frame) {
                             outcome.frames.emplace_back(frame);
                             return true;
                           })
                     .ok();
  }
  outcome.pending = splitter.pending_bytes();
  return outcome;
}

TEST(Framing, TheLengthIsLittleEndian) {
  EXPECT_EQ(Frame("abc"), std::string("\x03\x00\x00\x00"
                                      "abc",
                                      7));
  EXPECT_EQ(DecodeLength("\x78\x56\x34\x12"), 0x12345678u);
  EXPECT_EQ(DecodeLength(EncodeLength(0xfedcba98u).data()), 0xfedcba98u);
}

TEST(Framing, FramesComeOutWholeHoweverTheBytesAreCut) {
  const std::string bytes = Frame("one") + Frame("") + Frame(std::string(100, 'x')) + Frame("four");
  for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
    const Outcome outcome = FeedInPieces(bytes, piece);
    EXPECT_TRUE(outcome.ok);
    EXPECT_EQ(outcome.frames, (std::vector<std::string>{"one", "", std::string(100, 'x'), "four"}))
        << "pieces of " << piece;
    EXPECT_EQ(outcome.pending, 0u);
  }
}

TEST(Framing, ALengthOverTheLimitIsRefusedAtItsFourthByte) {
  const auto length = EncodeLength(101);
  const std::string bytes(length.begin(), length.end());
  for (std::size_t piece = 1; piece <= 4; ++piece) {
    EXPECT_FALSE(FeedInPieces(bytes, piece).ok);
  }
  EXPECT_TRUE(FeedInPieces(bytes.substr(0, 3), 1).ok);
  EXPECT_FALSE(FeedInPieces(Frame("fine") + bytes, 1000).ok);
}

TEST(Framing, AnIncompleteFrameKeepsNoMoreThanHasArrived) {
  FrameSplitter splitter(1u << 30);
  const auto length = EncodeLength(1u << 30);
  const auto never = [](std::string_view) { return false; };
  ASSERT_TRUE(splitter.Feed(std::string_view(length.data(), length.size()), never).ok());
  ASSERT_TRUE(splitter.Feed("abc", never).ok());
  EXPECT_EQ(splitter.pending_bytes(), 7u);
}

TEST(Framing, AReceiverThatStopsGetsNoFurtherFrame) {
  FrameSplitter splitter(100);
  int frames = 0;
  ASSERT_TRUE(splitter
                  .Feed(Frame("a") + Frame("b"),
                        [&](std::string_view) {
                          ++frames;
                          return false;
                        })
                  .ok());
  EXPECT_EQ(frames, 1);
}

std::string TickOf(int samples) {
  v1::Envelope message;
  message.mutable_tick()->set_sequence(7);
  for (int i = 0; i < samples; ++i) message.mutable_tick()->mutable_motion()->add_samples();
  return message.SerializeAsString();
}

std::string GapFrom(std::uint64_t sequence) {
  v1::Envelope message;
  message.mutable_gap()->set_from_sequence(sequence);
  return message.SerializeAsString();
}

TEST(MessageParser, AMessageHasNothingOfTheOneBefore) {
  for (const bool discarded : {false, true}) {
    MessageParser parser;
    const v1::Envelope* message = parser.Parse(TickOf(3));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 3);
    if (discarded) parser.Discard();
    message = parser.Parse(TickOf(2));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 2);
    if (discarded) parser.Discard();
    message = parser.Parse(GapFrom(5));
    ASSERT_NE(message, nullptr);
    EXPECT_FALSE(message->has_tick());
    EXPECT_EQ(message->gap().from_sequence(), 5u);
    if (discarded) parser.Discard();
    message = parser.Parse("");
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->body_case(), v1::Envelope::BODY_NOT_SET);
  }
}

TEST(MessageParser, GoesOnBehindBytesThatAreNoMessage) {
  MessageParser parser;
  EXPECT_EQ(parser.Parse(TickOf(3).substr(0, 6)), nullptr);
  const v1::Envelope* const message = parser.Parse(GapFrom(5));
  ASSERT_NE(message, nullptr);
  EXPECT_FALSE(message->has_tick());
  EXPECT_EQ(message->gap().from_sequence(), 5u);
}

TEST(MessageParser, TakesMessagesLongerThanItsBlock) {
  MessageParser parser;
  for (int round = 0; round < 3; ++round) {
    const v1::Envelope* const message = parser.Parse(TickOf(5000));
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->tick().motion().samples_size(), 5000);
    if (round == 1) parser.Discard();
  }
}

}  // namespace
}  // namespace footing::transport

/// The examples of docs/protocol.md: fenced blocks of the language "frame" (or "device-frame") with
/// hex bytes. The comments after # are the message in protobuf's text form: two further spaces a
/// level, "name, N bytes" for a message.
namespace footing {
namespace {

struct Example {
  int line = 0;
  std::string bytes;
  std::string text;
  std::vector<std::size_t> open;  // Levels of the messages that the text has begun.
};

/// The bytes of one line of hex, without its comment.
std::string BytesOf(const std::string& line) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string bytes;
  for (std::string word; words >> word;) {
    bytes.push_back(static_cast<char>(std::stoi(word, nullptr, 16)));
  }
  return bytes;
}

/// Ends the messages at `level` and deeper.
void Close(Example& example, std::size_t level) {
  for (; !example.open.empty() && example.open.back() >= level; example.open.pop_back()) {
    example.text += "}\n";
  }
}

void AddComment(Example& example, const std::string& line) {
  const std::size_t hash = line.find('#');
  if (hash == std::string::npos) return;
  const std::size_t word = line.find_first_not_of(' ', hash + 1);
  Close(example, word - hash);
  const std::string comment = line.substr(word);
  const std::size_t comma = comment.find(", ");
  const bool begins = comment.find(':') == std::string::npos && comma != std::string::npos;
  example.text += begins ? comment.substr(0, comma) + " {\n" : comment + "\n";
  if (begins) example.open.push_back(word - hash);
}

std::vector<Example> ExamplesOf(const std::string& language) {
  std::ifstream file(FOOTING_SOURCE_DIR "/docs/protocol.md");
  std::vector<Example> examples;
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line == "```" + language) {
      inside = true;
      examples.push_back({number, "", "", {}});
    } else if (line.rfind("```", 0) == 0) {
      if (inside) Close(examples.back(), 0);
      inside = false;
    } else if (inside) {
      const bool length =
          examples.back().bytes.empty();  // The first line is the frame's length, not a field.
      examples.back().bytes += BytesOf(line);
      if (!length) AddComment(examples.back(), line);
    }
  }
  return examples;
}

/// Checks one example: length, bytes to message, message to text, and message to bytes again.
template <typename Message>
Message Check(const Example& example) {
  SCOPED_TRACE("docs/protocol.md:" + std::to_string(example.line));
  Message decoded;
  Message expected;
  EXPECT_GT(example.bytes.size(), transport::kLengthBytes);
  const std::string payload = example.bytes.substr(transport::kLengthBytes);
  EXPECT_EQ(transport::DecodeLength(example.bytes.data()), payload.size());
  EXPECT_TRUE(decoded.ParseFromString(payload));
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(example.text, &expected));
  std::string difference;
  google::protobuf::util::MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(expected, decoded)) << difference;
  EXPECT_EQ(decoded.SerializeAsString(), payload);
  return decoded;
}

TEST(ProtocolExamples, BytesAndCommentsOfEveryMessageAgree) {
  std::set<int> shown;
  for (const Example& example : ExamplesOf("frame")) {
    shown.insert(static_cast<int>(Check<v1::Envelope>(example).body_case()));
  }
  const auto* bodies = v1::Envelope::descriptor();
  for (int i = 0; i < bodies->field_count(); ++i) {
    EXPECT_EQ(shown.count(bodies->field(i)->number()), 1u)
        << "docs/protocol.md has no example of " << bodies->field(i)->name();
  }
}

TEST(ProtocolExamples, TheDeviceSocketsExamplesAgree) {
  const auto examples = ExamplesOf("device-frame");
  EXPECT_GE(examples.size(), 2u);
  for (const Example& example : examples) Check<v1::DeviceEnvelope>(example);
}

}  // namespace
}  // namespace footing
