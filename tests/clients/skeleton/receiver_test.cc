#include "clients/skeleton/receiver.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include "clients/skeleton/sender.h"
#include "common/net/udp.h"
#include "tests/clients/skeleton/clips.h"

namespace footing::skeleton {
namespace {

/// A port that nobody listens on now.
boost::asio::ip::udp::endpoint FreePort() {
  boost::asio::io_context io;
  boost::asio::ip::udp::socket socket(io, *transport::ParseUdp("127.0.0.1:0", ""));
  return socket.local_endpoint();
}

/// Returns when the port is bound, as the kernel lists it, or after a minute.
void WaitForListener(std::uint16_t port) {
  char wanted[16];
  std::snprintf(wanted, sizeof wanted, ":%04X ", port);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  for (bool bound = false; !bound && std::chrono::steady_clock::now() < end;
       std::this_thread::yield()) {
    std::ifstream table("/proc/net/udp");
    for (std::string line; std::getline(table, line);)
      bound = bound || line.find(wanted) != std::string::npos;
  }
}

struct Exchange {
  Result<nlohmann::ordered_json> sent = Failure("not run");
  Result<Reception> received = Failure("not run");
};

constexpr int kRunsS = 3;

/// A receiver that runs for three seconds, and a sender beside it, which needs less than one.
Exchange SendToReceiver(ReceiverOptions options, std::size_t frames, double rate_hz) {
  options.listen = FreePort();
  options.seconds = kRunsS;
  Exchange exchange;
  std::thread receiver([&] { exchange.received = RunReceiver(options); });
  WaitForListener(options.listen.port());
  SenderOptions sender;
  sender.to = options.listen;
  sender.rate_hz = rate_hz;
  exchange.sent = SendClip(std::vector<ClipFrame>(frames, {0, Standing()}), sender);
  receiver.join();
  return exchange;
}

TEST(Receiver, CountsWhatASenderSends) {
  const auto [sent, received] = SendToReceiver({}, 50, 200);
  ASSERT_TRUE(sent);
  ASSERT_TRUE(received) << received.error().message;
  EXPECT_EQ((*sent)["packets"], 50);
  EXPECT_EQ(received->statistics["packets"], 50);
  EXPECT_EQ(received->statistics["skeletons"], 50);
  EXPECT_EQ(received->statistics["published"], 0) << "there is no footingd";
  EXPECT_EQ(received->statistics["advice"], "");
  EXPECT_EQ(received->statistics["people"][0]["joints"], 50 * kJoints);
  EXPECT_EQ(received->statistics["people"][0]["dialect"], "footing");
}

TEST(Receiver, DropsMorePacketsThanItIsAllowed) {
  ReceiverOptions options;
  options.most_packets_per_s = 50;
  const auto [sent, received] = SendToReceiver(options, 100, 1000);
  ASSERT_TRUE(sent);
  ASSERT_TRUE(received);
  const int taken = received->statistics["packets"],
            dropped = received->statistics["dropped_packets"];
  EXPECT_EQ(taken + dropped, 100);
  EXPECT_LE(taken, 5 + 50 * kRunsS + 1);  // A bucket of 5, and 50 a second.
  EXPECT_GT(dropped, 0);  // Sent within 0.1 s, or a second on a machine that stalls.
}

TEST(Receiver, SaysWhenFootingdNeverCame) {
  ReceiverOptions options;
  options.listen = FreePort();
  options.to = transport::ParseAddress("unix:/nonexistent/devices.sock").value();
  options.seconds = 0.5;
  const auto received = RunReceiver(options);
  ASSERT_TRUE(received) << received.error().message;
  EXPECT_EQ(received->statistics["packets"], 0);
  ASSERT_FALSE(received->published);
  EXPECT_EQ(received->published.error().kind, ErrorKind::kNoDevice);
  EXPECT_NE(received->published.error().message.find("unix:/nonexistent/devices.sock"),
            std::string::npos);
  options.to.reset();  // Nothing is to be published.
  EXPECT_TRUE(RunReceiver(options)->published);
}

TEST(Receiver, SaysWhenItsPortIsTaken) {
  boost::asio::io_context io;
  const boost::asio::ip::udp::socket taken(io, *transport::ParseUdp("127.0.0.1:0", ""));
  ReceiverOptions options;
  options.listen = taken.local_endpoint();
  options.seconds = 1;
  const auto refused = RunReceiver(options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kFailure);
  EXPECT_NE(refused.error().message.find("--listen"), std::string::npos);
}

}  // namespace
}  // namespace footing::skeleton
