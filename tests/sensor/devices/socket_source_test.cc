#include "daemon/sensor/devices/socket_source.h"

#include <gmock/gmock.h>
#include <google/protobuf/unknown_field_set.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/net/framing.h"
#include "footing/v1/device.pb.h"
#include "tests/sensor/devices/socket_source_fixture.h"

namespace footing::devices {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(SocketSourceTest, AStandInAttachesReportsIsWrittenToAndGoes) {
  auto peer = Connect();
  peer->Attach(3, "52:00");
  peer->Report(3, std::string(6, '\x31'));
  EXPECT_TRUE(RunUntil([this] { return !reported_.empty(); }));
  ASSERT_THAT(attached_, ElementsAre(1));
  EXPECT_EQ(identities_[0].serial, "52:00");
  EXPECT_TRUE(identities_[0].simulated);
  EXPECT_EQ(identities_[0].wished_role, stream::DeviceRole::kRightHand);
  EXPECT_THAT(sizes_, ElementsAre(6));

  source_.Send(1, {0x15, 0x00});
  EXPECT_TRUE(RunUntil([&peer] { return !peer->received.empty(); }));
  EXPECT_EQ(peer->received[0].output().slot(), 3u);
  EXPECT_EQ(peer->received[0].output().report(), std::string("\x15\x00", 2));

  peer->connection.reset();
  EXPECT_TRUE(RunUntil([this] { return !detached_.empty(); }));
  EXPECT_THAT(detached_, ElementsAre(1));
  source_.Send(1, {0x15, 0x00});  // To a device that is gone: nothing happens.
}

TEST_F(SocketSourceTest, AFaultAndADetachEndTheirDeviceAlone) {
  auto peer = Connect();
  peer->Attach(0, "a");
  peer->Attach(1, "b");
  peer->Attach(2, "c");
  v1::DeviceEnvelope fault;
  fault.mutable_fault()->set_slot(0);
  fault.mutable_fault()->set_error_number(5);
  peer->Send(fault);
  v1::DeviceEnvelope detach;
  detach.mutable_detach()->set_slot(1);
  peer->Send(detach);
  peer->Report(2, "x");
  EXPECT_TRUE(RunUntil([this] { return !reported_.empty(); }));
  EXPECT_THAT(detached_, ElementsAre(1, 2));
  EXPECT_THAT(reported_, ElementsAre(3));
}

TEST_F(SocketSourceTest, WhatMakesNoSenseClosesItsConnectionWithOneLine) {
  const std::pair<const char*, std::function<void(Peer&)>> kRubbish[] = {
      {"not a DeviceEnvelope", [](Peer& peer) { peer.connection->Send(std::string(300, '\xff')); }},
      {"message is empty", [](Peer& peer) { peer.Send({}); }},
      {"slot with no device", [](Peer& peer) { peer.Report(9, "x"); }},
      {"unknown", [](Peer& peer) { peer.Attach(0, "a", 0x1234); }},
      {"serial is empty", [](Peer& peer) { peer.Attach(0, ""); }},
      {"printable", [](Peer& peer) { peer.Attach(0, "a\nb"); }},
      {"slot 3 is taken",
       [](Peer& peer) {
         peer.Attach(3, "a");
         peer.Attach(3, "b");
       }},
      {"a connection has at most 16 devices",
       [](Peer& peer) {
         for (std::uint32_t slot = 0; slot < 17; ++slot) {
           peer.Attach(slot, "a" + std::to_string(slot));
         }
       }},
      {"other way",
       [](Peer& peer) {
         v1::DeviceEnvelope envelope;
         envelope.mutable_output()->set_slot(0);
         peer.Send(envelope);
       }},
  };
  auto healthy = Connect();
  healthy->Attach(0, "healthy");
  for (const auto& [line, send] : kRubbish) {
    trouble_.clear();
    auto peer = Connect();
    send(*peer);
    EXPECT_TRUE(RunUntil([&peer] { return peer->closed; }));
    ASSERT_EQ(trouble_.size(), 1u) << line;
    EXPECT_THAT(trouble_[0], HasSubstr(line));
    ASSERT_FALSE(peer->received.empty()) << line;
    EXPECT_THAT(peer->received.back().refused().reason(), HasSubstr(line));
  }
  healthy->Report(0, "x");
  EXPECT_TRUE(RunUntil([this] { return !reported_.empty(); }));
  EXPECT_FALSE(healthy->closed);
  EXPECT_EQ(attached_.size(), detached_.size() + 1);
}

TEST_F(SocketSourceTest, AMessageOfALaterVersionIsIgnoredWithOneLine) {
  auto peer = Connect();
  peer->Attach(0, "a");
  v1::DeviceEnvelope later;
  later.GetReflection()->MutableUnknownFields(&later)->AddLengthDelimited(99, "new");
  for (int i = 0; i < 3; ++i) peer->Send(later);
  peer->Report(0, "x");
  EXPECT_TRUE(RunUntil([this] { return !reported_.empty(); }));
  EXPECT_FALSE(peer->closed);
  ASSERT_EQ(trouble_.size(), 1u);
  EXPECT_THAT(trouble_[0], HasSubstr("does not know is ignored"));
}

TEST_F(SocketSourceTest, AnOversizedMessageEndsTheConnection) {
  auto peer = Connect();
  peer->Attach(0, "a");
  peer->Report(0, std::string(3000, 'x'));
  EXPECT_TRUE(RunUntil([&peer] { return peer->closed; }));
  EXPECT_EQ(attached_.size(), 1u);
  EXPECT_EQ(detached_.size(), 1u);
  EXPECT_TRUE(reported_.empty());
  ASSERT_EQ(trouble_.size(), 1u);
  EXPECT_THAT(trouble_[0], HasSubstr("little-endian"));
  ASSERT_FALSE(peer->received.empty());
  EXPECT_THAT(peer->received.back().refused().reason(), HasSubstr("little-endian"));
}

TEST_F(SocketSourceTest, HandAndReferenceFramesNeedNoSlotAndMayBeBad) {
  auto peer = Connect();
  v1::DeviceEnvelope hands;
  hands.mutable_hand_frame()->set_tracker("eye");
  hands.mutable_hand_frame()->add_points()->set_x_m(1e300);
  peer->Send(hands);
  v1::DeviceEnvelope reference;
  reference.mutable_reference_frame()->add_parents(-1);
  for (int i = 0; i < 2; ++i) reference.mutable_reference_frame()->add_position_m(1);
  peer->Send(reference);
  peer->Attach(0, "a");
  EXPECT_TRUE(RunUntil([this] { return !attached_.empty(); }));
  ASSERT_EQ(hands_.size(), 1u);
  EXPECT_EQ(hands_[0].points[0].position_m.x(), 1e300);
  ASSERT_EQ(references_.size(), 1u);
  EXPECT_EQ(references_[0].positions_m.size(), 1u);
  EXPECT_FALSE(peer->closed);
}

TEST_F(SocketSourceTest, TheLargestFramesThatAreTakenFitIntoAMessage) {
  auto peer = Connect();
  v1::DeviceEnvelope hands;
  hands.mutable_hand_frame()->set_tracker(std::string(64, 't'));
  hands.mutable_hand_frame()->set_rig(std::string(64, 'r'));
  hands.mutable_hand_frame()->set_age_ns(1'000'000'000);
  hands.mutable_hand_frame()->set_simulated(true);
  for (int i = 0; i < 8; ++i) {
    v1::TrackedPoint& point = *hands.mutable_hand_frame()->add_points();
    point.set_role(v1::DEVICE_ROLE_LEFT_HAND);
    for (const auto set :
         {&v1::TrackedPoint::set_x_m, &v1::TrackedPoint::set_y_m, &v1::TrackedPoint::set_z_m,
          &v1::TrackedPoint::set_sd_x_m, &v1::TrackedPoint::set_sd_y_m,
          &v1::TrackedPoint::set_sd_z_m, &v1::TrackedPoint::set_confidence}) {
      (point.*set)(0.1);
    }
  }
  peer->Send(hands);
  v1::DeviceEnvelope reference;
  reference.mutable_reference_frame()->set_rig(std::string(64, 'r'));
  reference.mutable_reference_frame()->set_age_ns(1'000'000'000);
  for (int i = 0; i < 64; ++i) reference.mutable_reference_frame()->add_parents(i - 1);
  for (int i = 0; i < 3 * 64; ++i) reference.mutable_reference_frame()->add_position_m(0.1f);
  for (int i = 0; i < 3; ++i) reference.mutable_reference_frame()->add_com_m(0.1f);
  peer->Send(reference);
  v1::DeviceEnvelope contacts;
  v1::ContactFrame& insole = *contacts.mutable_contact_frame();
  insole.set_source(std::string(64, 's'));
  insole.set_rig(std::string(64, 'r'));
  insole.set_age_ns(1'000'000'000);
  insole.set_body(v1::CONTACT_BODY_RIGHT_FOOT);
  insole.set_simulated(true);
  for (int i = 0; i < 16; ++i) {
    v1::ContactCell& cell = *insole.add_cells();
    cell.set_x_m(0.1);
    cell.set_y_m(0.1);
    cell.set_z_m(0.1);
    cell.set_load_n(0.1);
  }
  peer->Send(contacts);
  EXPECT_TRUE(RunUntil([this] { return !contacts_.empty(); }));
  ASSERT_EQ(references_.size(), 1u);
  EXPECT_EQ(contacts_[0].cells.size(), 16u);
  EXPECT_EQ(contacts_[0].body, stream::ContactBody::kRightFoot);
  EXPECT_EQ(hands_.size(), 1u);
  EXPECT_FALSE(peer->closed);
}

TEST_F(SocketSourceTest, ASecondListenerOnTheSameAddressIsAnError) {
  SocketSource second(io_, AddressHere(), [] { return 1; }, {});
  const auto started = second.Start();
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, HasSubstr("devices.sock"));
}

}  // namespace
}  // namespace footing::devices
