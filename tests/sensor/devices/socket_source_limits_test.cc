#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>

#include "common/runtime/timer.h"
#include "footing/v1/device.pb.h"
#include "tests/common/runtime/simulated_time.h"
#include "tests/sensor/devices/socket_source_fixture.h"

// Devices that are not taken, and those that come too often.
namespace footing::devices {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

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

TEST_F(SocketSourceTest, ADeviceThatGivesWayIsToldWhyAndTheOthersGoOn) {
  auto peer = Connect();
  peer->Attach(4, "a");
  peer->Attach(5, "b");
  EXPECT_TRUE(RunUntil([this] { return attached_.size() == 2; }));
  source_.Refuse(attached_[0], "a real device takes its place");
  peer->Report(4, "x");
  peer->Report(5, "x");
  EXPECT_TRUE(RunUntil([&] { return !reported_.empty() && !peer->received.empty(); }));
  EXPECT_EQ(peer->received[0].refused().slot(), 4u);
  EXPECT_EQ(peer->received[0].refused().reason(), "a real device takes its place");
  EXPECT_THAT(reported_, ElementsAre(attached_[1]));
  EXPECT_THAT(detached_, ElementsAre()) << "its owner has let it go already";
  EXPECT_FALSE(peer->closed);
}

class SessionSourceTest : public SocketSourceTest {
 protected:
  /// An attachment of a Wiimote.
  static v1::DeviceEnvelope Attaching(std::uint32_t slot, const std::string& serial) {
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(slot);
    attach.set_vendor(0x057e);
    attach.set_product(0x0306);
    attach.set_name("Nintendo RVL-CNT-01");
    attach.set_serial(serial);
    return envelope;
  }
  static v1::DeviceEnvelope Reporting(std::uint32_t slot) {
    v1::DeviceEnvelope envelope;
    envelope.mutable_input_report()->set_slot(slot);
    envelope.mutable_input_report()->set_report("x");
    return envelope;
  }

  std::vector<std::pair<std::uint64_t, v1::DeviceEnvelope>> sent_;
  std::vector<std::pair<std::uint64_t, std::string>> ended_;
  SessionSource sessions_{
      [this] { return ++last_handle_; }, Handlers(),
      SessionLink{[this](std::uint64_t session, const v1::DeviceEnvelope& message) {
                    sent_.emplace_back(session, message);
                  },
                  [this](std::uint64_t session, const std::string& why) {
                    ended_.emplace_back(session, why);
                  }}};
};

TEST_F(SessionSourceTest, EachSessionHasSlotsOfItsOwnAndItsEndDetachesThem) {
  sessions_.Take(7, 1, Attaching(0, "a"));
  sessions_.Take(8, 1, Attaching(0, "b"));
  sessions_.Take(8, 1, Attaching(1, "taken"));
  EXPECT_EQ(identities_.back().place, "session 8, slot 1");
  sessions_.Take(7, 2, Reporting(0));
  sessions_.Take(8, 2, Reporting(0));
  EXPECT_THAT(reported_, ElementsAre(1, 2));
  ASSERT_EQ(sent_.size(), 1u) << "the refusal";
  EXPECT_EQ(sent_[0].first, 8u);
  EXPECT_EQ(sent_[0].second.refused().slot(), 1u);
  sessions_.Send(2, {0x15, 0x00});
  EXPECT_EQ(sent_.back().first, 8u);
  EXPECT_EQ(sent_.back().second.output().report(), std::string("\x15\x00", 2));
  sessions_.EndSession(7);
  sessions_.EndSession(9);  // It had none.
  EXPECT_THAT(detached_, ElementsAre(1));
  sessions_.Take(8, 3, Reporting(5));
  EXPECT_THAT(detached_, ElementsAre(1, 2)) << "it does not keep to the protocol";
  ASSERT_EQ(ended_.size(), 1u);
  EXPECT_EQ(ended_[0].first, 8u);
  EXPECT_EQ(ended_[0].second, "a report of a slot with no device");
  EXPECT_EQ(sent_.back().second.refused().reason(), "a report of a slot with no device");
  EXPECT_THAT(trouble_, ElementsAre(HasSubstr("devices of session 8")));
  sessions_.Stop();
  sessions_.Take(9, 4, Attaching(0, "c"));
  EXPECT_EQ(attached_.size(), 3u) << "nothing comes in while the sessions are drained";
}

TEST_F(SessionSourceTest, StampsOfAnotherHostsClockAreIgnored) {
  v1::DeviceEnvelope hands;
  hands.mutable_hand_frame()->set_age_ns(20);
  hands.mutable_hand_frame()->set_sent_ns(1);
  sessions_.Take(7, 5, hands);
  ASSERT_EQ(hands_.size(), 1u);
  EXPECT_EQ(hands_[0].age_ns, 20);
  EXPECT_EQ(hands_[0].sent_ns, 0);
}

TEST(ConnectionLimits, OneUserCannotTakeEveryPlaceAndAdministratorsHaveTheirOwn) {
  const ConnectionLimits limits = {64, 16};
  constexpr uid_t kOwn = 500;
  const transport::Peer user = {true, 1000, {}}, own = {true, kOwn, {}}, root = {true, 0, {}};
  EXPECT_EQ(WhyNoConnection(limits, user, kOwn, {15, 15}), "");
  EXPECT_THAT(WhyNoConnection(limits, user, kOwn, {16, 16}), HasSubstr("of this user"));
  EXPECT_EQ(WhyNoConnection(limits, user, kOwn, {63, 0}), "");
  EXPECT_THAT(WhyNoConnection(limits, user, kOwn, {64, 0}), HasSubstr("64 connections"));
  for (const auto& admin : {own, root}) {
    EXPECT_EQ(WhyNoConnection(limits, admin, kOwn, {71, 71}), "");
    EXPECT_NE(WhyNoConnection(limits, admin, kOwn, {72, 0}), "");
  }
  EXPECT_THAT(WhyNoConnection(limits, {}, kOwn, {16, 16}), HasSubstr("over TCP"));
}

TEST_F(SocketSourceTest, AConnectionTooManyHearsWhyAndIsClosed) {
  transport::Address address{transport::Address::Kind::kTcp, "", "127.0.0.1", 0};
  SocketSource source(io_, address, [this] { return ++last_handle_; }, Handlers(), {64, 2});
  ASSERT_TRUE(source.Start());
  auto first = ConnectTo(source.address());
  auto second = ConnectTo(source.address());
  auto third = ConnectTo(source.address());
  EXPECT_TRUE(RunUntil([&] { return third->closed; }));
  ASSERT_EQ(third->received.size(), 1u);
  EXPECT_THAT(third->received[0].refused().reason(), HasSubstr("2 connections over TCP already"));
  EXPECT_THAT(trouble_, ElementsAre(HasSubstr("a connection was refused")));
  first->connection.reset();
  second->Attach(0, "a");
  EXPECT_TRUE(RunUntil([this] { return attached_.size() == 1; }));
  auto fourth = ConnectTo(source.address());
  fourth->Attach(0, "b");
  EXPECT_TRUE(RunUntil([this] { return attached_.size() == 2; }));
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

/// On simulated time; the source is made on it.
class IdleConnections : private timer::SimulatedTime, public SocketSourceTest {
 protected:
  void Wait(std::chrono::seconds duration) {
    bool over = false;
    timer::Timer timer(io_);
    timer.expires_after(duration);
    timer.async_wait([&over](const boost::system::error_code&) { over = true; });
    EXPECT_TRUE(RunUntil([&over] { return over; }));
  }
};

TEST_F(IdleConnections, AreClosedAfterTenSecondsUnlessTheyHaveADevice) {
  auto silent = Connect(), attached = Connect(), detached = Connect();
  attached->Attach(0, "a");
  detached->Attach(0, "b");
  EXPECT_TRUE(RunUntil([this] { return attached_.size() == 2; }));
  Wait(std::chrono::seconds(9));
  EXPECT_FALSE(silent->closed);
  v1::DeviceEnvelope detach;
  detach.mutable_detach()->set_slot(0);
  detached->Send(detach);
  Wait(std::chrono::seconds(3));
  EXPECT_TRUE(silent->closed);
  ASSERT_EQ(silent->received.size(), 1u);
  EXPECT_THAT(silent->received[0].refused().reason(), HasSubstr("sent nothing for 10 s"));
  EXPECT_FALSE(detached->closed) << "it was heard 3 s ago";
  Wait(std::chrono::seconds(9));
  EXPECT_TRUE(detached->closed);
  EXPECT_FALSE(attached->closed) << "a device may be silent: it is stale";
}

}  // namespace
}  // namespace footing::devices
