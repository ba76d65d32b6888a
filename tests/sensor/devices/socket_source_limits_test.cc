#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>

#include "footing/v1/device.pb.h"
#include "tests/sensor/devices/socket_source_fixture.h"

// Devices that are not taken, and those that come too often.
namespace footing::devices {
namespace {

using testing::ElementsAre;

TEST_F(SocketSourceTest, ADeviceThatIsNotTakenIsToldWhyAndTheOthersGoOn) {
  auto peer = Connect();
  peer->Attach(0, "a");
  peer->Attach(1, "taken");
  peer->Report(1, std::string(6, '\x31'));  // Sent before it could know: ignored.
  peer->Report(0, std::string(6, '\x31'));
  EXPECT_TRUE(RunUntil([&] { return !reported_.empty() && !peer->received.empty(); }));
  EXPECT_EQ(peer->received[0].refused().slot(), 1u);
  EXPECT_EQ(peer->received[0].refused().reason(), "there is one already");
  EXPECT_THAT(reported_, ElementsAre(1));
  EXPECT_FALSE(peer->closed);
  peer->Attach(1, "b");  // The slot is free for another.
  EXPECT_TRUE(RunUntil([this] { return attached_.size() == 3; }));
}

TEST_F(SocketSourceTest, AttachingInALoopIsSlowed) {
  auto peer = Connect();
  v1::DeviceEnvelope detach;
  detach.mutable_detach()->set_slot(0);
  for (int i = 0; i < 500; ++i) {
    peer->Attach(0, "a");
    peer->Send(detach);
  }
  bool late = false;
  boost::asio::steady_timer timer(io_, std::chrono::milliseconds(300));
  timer.async_wait([&](const boost::system::error_code&) { late = true; });
  EXPECT_TRUE(RunUntil([&] { return late; }));
  // 5000 of budget are 50 at 100 each, and 50 more a second.
  EXPECT_GE(attached_.size(), 40u);
  EXPECT_LE(attached_.size(), 100u);
}

}  // namespace
}  // namespace footing::devices
