#include <random>

#include "common/net/framing.h"
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
}  // namespace footing::transport
