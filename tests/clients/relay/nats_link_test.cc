#include "clients/relay/nats_link.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/common/net/io_fixture.h"

/// Cases that a real server shows only by chance, or only when it is broken. The others are in
/// tests/scenarios/relay.py.
namespace footing::relay {
namespace {

using boost::asio::ip::tcp;

class NatsLinkTest : public transport::IoFixture {
 protected:
  void Start(NatsOptions options = {}) {
    acceptor_.emplace(io_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0));
    options.address = TcpAddress();
    options.address.port = acceptor_->local_endpoint().port();
    options.client_name = "test";
    link_.emplace(
        io_, options,
        NatsLinkHandlers{
            [this] { ++ups_; }, [this](const std::string& why) { downs_.push_back(why); },
            [this](const nats::Message& message) { messages_.emplace_back(message.payload); }});
    link_->Start();
    Accept();
  }

  void Accept() {
    socket_.emplace(io_);
    bool accepted = false;
    acceptor_->async_accept(*socket_,
                            [&](const boost::system::error_code& error) { accepted = !error; });
    ASSERT_TRUE(RunUntil([&] { return accepted; }));
    socket_->non_blocking(true);
    received_.clear();
  }

  void Say(const std::string& bytes) {
    boost::system::error_code error;
    boost::asio::write(*socket_, boost::asio::buffer(bytes), error);
  }

  /// Whether this arrives at the server.
  bool Gets(const std::string& text) {
    return RunUntil([&] {
      std::array<char, 4096> bytes;
      boost::system::error_code error;
      const std::size_t count = socket_->read_some(boost::asio::buffer(bytes), error);
      if (!error) received_.append(bytes.data(), count);
      return received_.find(text) != std::string::npos;
    });
  }

  void Greet() {
    Say("INFO {\"max_payload\":1000}\r\n");
    ASSERT_TRUE(Gets("PING\r\n"));
    Say("PONG\r\n");
    ASSERT_TRUE(RunUntil([&] { return link_->up(); }));
  }

  std::optional<tcp::acceptor> acceptor_;
  std::optional<tcp::socket> socket_;
  std::string received_;
  std::optional<NatsLink> link_;
  int ups_ = 0;
  std::vector<std::string> downs_, messages_;
};

TEST_F(NatsLinkTest, WhatIsSubscribedWhileTheServerGreetsIsNotForgotten) {
  Start();
  link_->Subscribe("early");
  Say("INFO {\"max_payload\":1000}\r\n");
  ASSERT_TRUE(Gets("SUB early 1\r\nPING\r\n"));
  link_->Subscribe("between");
  Say("PONG\r\n");
  EXPECT_TRUE(Gets("SUB between 2\r\n"));
  link_->Subscribe("late");
  EXPECT_TRUE(Gets("SUB late 3\r\n"));
}

TEST_F(NatsLinkTest, SubscriptionsLastOverAReconnection) {
  Start();
  link_->Subscribe("a");
  EXPECT_FALSE(link_->Publish("x", "y"));  // Not lost: no server was there yet.
  EXPECT_EQ(link_->dropped(), 0u);
  Greet();
  socket_->close();
  ASSERT_TRUE(RunUntil([&] { return !downs_.empty(); }));
  EXPECT_FALSE(link_->Publish("x", "y"));
  EXPECT_EQ(link_->dropped(), 1u);
  Accept();
  Say("INFO {}\r\n");
  EXPECT_TRUE(Gets("SUB a 1\r\n"));
}

TEST_F(NatsLinkTest, AMessageLongerThanTheServerTakesIsNotSent) {
  Start();
  Greet();
  EXPECT_FALSE(link_->Publish("x", std::string(1001, 'y')));
  EXPECT_EQ(link_->dropped(), 1u);
  EXPECT_TRUE(link_->Publish("x", std::string(1000, 'y')));
  EXPECT_TRUE(Gets("PUB x 1000\r\n"));
}

TEST_F(NatsLinkTest, AServerThatTakesNothingFillsNoMemory) {
  NatsOptions options;
  options.max_queued_bytes = 100'000;
  Start(options);
  Greet();
  int taken = 0;
  for (int i = 0; i < 100'000; ++i) taken += link_->Publish("x", std::string(1000, 'y')) ? 1 : 0;
  // One write of at most what the kernel takes is under way; behind it the queue.
  EXPECT_LT(taken, 200);
  EXPECT_EQ(link_->dropped(), 100'000u - static_cast<unsigned>(taken));
}

TEST_F(NatsLinkTest, WhatIsTooLongOrNotNatsEndsTheConnection) {
  for (const char* const bytes : {"MSG a 1 99999999\r\n", "HTTP/1.1 200 OK\r\n"}) {
    downs_.clear();
    Start();
    Greet();
    Say(bytes);
    ASSERT_TRUE(RunUntil([&] { return !downs_.empty(); }));
    EXPECT_FALSE(link_->up());
  }
}

TEST_F(NatsLinkTest, TheServersOwnWordsSayWhyItEnds) {
  Start();
  Say("INFO {\"auth_required\":true}\r\n-ERR 'Authorization Violation'\r\n");
  ASSERT_TRUE(Gets("CONNECT"));
  socket_->close();
  ASSERT_TRUE(RunUntil([&] { return !downs_.empty(); }));
  EXPECT_NE(downs_[0].find("Authorization Violation"), std::string::npos) << downs_[0];
}

TEST_F(NatsLinkTest, ASilentServerIsGivenUp) {
  NatsOptions options;
  options.ping_interval_s = 0.05;
  options.dead_after_s = 0.2;
  Start(options);
  Greet();
  ASSERT_TRUE(RunUntil([&] { return !downs_.empty(); }));
  EXPECT_NE(downs_[0].find("does not answer"), std::string::npos) << downs_[0];
}

}  // namespace
}  // namespace footing::relay
