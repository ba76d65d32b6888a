#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/net/framing.h"
#include "common/net/socket.h"
#include "daemon/sensor/devices/socket_source.h"
#include "footing/v1/device.pb.h"
#include "tests/common/net/io_fixture.h"

namespace footing::devices {

/// A program that simulates devices: sends what the test says.
class Peer {
 public:
  explicit Peer(transport::Socket socket) {
    transport::FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) {
      v1::DeviceEnvelope envelope;
      ASSERT_TRUE(envelope.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
      received.push_back(envelope);
    };
    handlers.on_close = [this](const std::string&) { closed = true; };
    connection = std::make_unique<transport::FramedConnection>(
        std::move(socket), transport::FramedLimits(), std::move(handlers));
    connection->Start();
  }

  void Send(const v1::DeviceEnvelope& envelope) { connection->Send(envelope.SerializeAsString()); }
  void Attach(std::uint32_t slot, const std::string& serial, std::uint32_t product = 0x0306) {
    v1::DeviceEnvelope envelope;
    v1::DeviceAttach& attach = *envelope.mutable_attach();
    attach.set_slot(slot);
    attach.set_vendor(0x057e);
    attach.set_product(product);
    attach.set_name("Nintendo RVL-CNT-01");
    attach.set_serial(serial);
    attach.set_role(v1::DEVICE_ROLE_RIGHT_HAND);
    Send(envelope);
  }
  void Report(std::uint32_t slot, const std::string& bytes) {
    v1::DeviceEnvelope envelope;
    envelope.mutable_input_report()->set_slot(slot);
    envelope.mutable_input_report()->set_report(bytes);
    Send(envelope);
  }

  std::unique_ptr<transport::FramedConnection> connection;
  std::vector<v1::DeviceEnvelope> received;
  bool closed = false;
};

class SocketSourceTest : public transport::IoFixture {
 protected:
  SocketSourceTest()
      : source_(
            io_, AddressHere(), [this] { return ++last_handle_; }, Handlers()) {
    const auto started = source_.Start();
    EXPECT_TRUE(started) << started.error().message;
  }

  transport::Address AddressHere() const { return UnixAddress("devices.sock"); }
  std::unique_ptr<Peer> Connect() { return ConnectTo(AddressHere()); }
  std::unique_ptr<Peer> ConnectTo(const transport::Address& address) {
    std::unique_ptr<Peer> peer;
    transport::Dial(io_, address, [&peer](Result<transport::Socket> socket) {
      ASSERT_TRUE(socket);
      peer = std::make_unique<Peer>(std::move(socket).value());
    });
    EXPECT_TRUE(RunUntil([&peer] { return peer != nullptr; }));
    return peer;
  }

  SourceHandlers Handlers() {
    SourceHandlers handlers;
    handlers.on_attach = [this](DeviceHandle device, const DeviceIdentity& identity) {
      attached_.push_back(device);
      identities_.push_back(identity);
      return identity.serial == "taken" ? std::string("there is one already") : std::string();
    };
    handlers.on_report = [this](DeviceHandle device, const IncomingReport& report) {
      reported_.push_back(device);
      sizes_.push_back(report.bytes.size());
    };
    handlers.on_detach = [this](DeviceHandle device, const std::string&) {
      detached_.push_back(device);
    };
    handlers.on_hands = [this](std::int64_t, const stream::HandFrame& frame) {
      hands_.push_back(frame);
    };
    handlers.on_contacts = [this](std::int64_t, const stream::ContactFrame& frame) {
      contacts_.push_back(frame);
    };
    handlers.on_reference = [this](std::int64_t, const stream::ReferenceFrame& frame) {
      references_.push_back(frame);
    };
    handlers.on_trouble = [this](const std::string& line) { trouble_.push_back(line); };
    return handlers;
  }

  DeviceHandle last_handle_ = 0;
  std::vector<DeviceHandle> attached_, reported_, detached_;
  std::vector<DeviceIdentity> identities_;
  std::vector<std::size_t> sizes_;
  std::vector<std::string> trouble_;
  std::vector<stream::HandFrame> hands_;
  std::vector<stream::ReferenceFrame> references_;
  std::vector<stream::ContactFrame> contacts_;
  SocketSource source_;
};

}  // namespace footing::devices
