#include "daemon/sensor/devices/socket_source.h"

#include <chrono>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "common/clock/clock.h"
#include "common/timer/timer.h"
#include "common/transport/framed_connection.h"
#include "common/transport/listener.h"
#include "common/transport/turn_queue.h"
#include "common/units/units.h"
#include "common/wire/wire.h"
#include "daemon/sensor/devices/attachment.h"
#include "footing/v1/device.pb.h"

namespace footing::devices {
namespace {

/// 16 devices of 200 reports a second take two thirds.
constexpr transport::InputBudget kBudget = {5000, 5000, 1 << 20, 1 << 20};
constexpr double kAttachCost = 100;  // In messages: it rebuilds a rig, and reads a calibration.
constexpr auto kIdleCheckInterval = std::chrono::seconds(1);
constexpr std::int64_t kIdleNs = 10 * kNanosecondsPerSecond;

}  // namespace

class SocketSource::Implementation {
 public:
  Implementation(boost::asio::io_context& io, const transport::Address& address,
                 std::function<DeviceHandle()> new_handle, SourceHandlers handlers)
      : io_(io),
        address_(address),
        new_handle_(std::move(new_handle)),
        handlers_(std::move(handlers)),
        idle_check_(io) {
    loop_.turns = std::make_shared<transport::TurnQueue>(io.get_executor());
  }

  Result<void> Start() {
    auto listener = transport::Listener::Open(
        io_, address_, [this](transport::Socket socket) { Accept(std::move(socket)); });
    if (!listener) return listener.error();
    listener_ = std::move(listener).value();
    CheckIdleLater();
    return {};
  }

  void Send(DeviceHandle device, const reports::OutputReport& report) {
    const auto place = places_.find(device);
    if (place == places_.end()) return;
    v1::DeviceEnvelope envelope;
    v1::DeviceOutput& output = *envelope.mutable_output();
    output.set_slot(place->second.slot);
    output.set_channel(v1::DeviceOutput::CHANNEL_INTERRUPT);
    output.set_report(report.data(), report.size());
    // A simulated device that does not read loses its outputs, as a device out of range does.
    connections_.at(place->second.connection).link->Send(envelope.SerializeAsString());
  }

  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
    const auto place = places_.find(device);
    if (place == places_.end()) return;
    v1::DeviceEnvelope envelope;
    v1::DeviceOutput& output = *envelope.mutable_output();
    output.set_slot(place->second.slot);
    output.set_channel(v1::DeviceOutput::CHANNEL_FEATURE_GET);
    output.set_report(&id, 1);
    output.set_size(static_cast<std::uint32_t>(size));
    connections_.at(place->second.connection).link->Send(envelope.SerializeAsString());
  }

  void Stop() {
    idle_check_.cancel();
    listener_.reset();
    connections_.clear();
    places_.clear();
  }

 private:
  struct Connection {
    std::unique_ptr<transport::FramedConnection> link;
    std::map<std::uint32_t, DeviceHandle> slots;
    std::set<std::uint32_t> refused_slots;
    std::int64_t heard_ns = 0;
    bool closing = false;
  };
  struct Place {
    std::uint64_t connection;
    std::uint32_t slot;
  };

  void Accept(transport::Socket socket) {
    if (connections_.size() >= kMaxConnections) {
      handlers_.on_trouble("device socket: more than " + std::to_string(kMaxConnections) +
                           " connections; one was refused");
      return;
    }
    const std::uint64_t id = ++last_connection_;
    transport::FramedLimits limits;
    limits.max_in_bytes = kMaxEnvelopeBytes;
    limits.max_out_bytes = kMaxEnvelopeBytes;
    limits.max_queued_bytes = 64 * kMaxEnvelopeBytes;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this, id](std::string_view payload) { OnFrame(id, payload); };
    handlers.on_bytes = [this, id] { connections_.at(id).heard_ns = clock::MonotonicNs(); };
    handlers.on_close = [this, id](const std::string& reason) { OnClose(id, reason); };
    limits.input = kBudget;
    Connection& connection = connections_[id];
    connection.heard_ns = clock::MonotonicNs();
    connection.link = std::make_unique<transport::FramedConnection>(std::move(socket), limits,
                                                                    std::move(handlers), loop_);
    connection.link->Start();
  }

  void CheckIdleLater() {
    idle_check_.expires_after(kIdleCheckInterval);
    idle_check_.async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      CloseIdle(clock::MonotonicNs());
      CheckIdleLater();
    });
  }

  /// A connection without a device that sends nothing takes a place from others.
  void CloseIdle(std::int64_t now_ns) {
    for (auto& [id, connection] : connections_) {
      const bool idle = connection.slots.empty() && now_ns - connection.heard_ns > kIdleNs;
      if (idle && !connection.closing) {
        Refuse(connection, "a connection without a device sent nothing for 10 s");
      }
    }
  }

  void OnFrame(std::uint64_t id, std::string_view payload) {
    Connection& connection = connections_.at(id);
    if (connection.closing) return;
    const std::int64_t received_ns = connection.heard_ns;  // When it was read; its turn came later.
    if (!envelope_.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
      Refuse(connection, "a message is not a DeviceEnvelope");
      return;
    }
    switch (envelope_.body_case()) {
      case v1::DeviceEnvelope::kAttach:
        Attach(id, connection, envelope_.attach());
        return;
      case v1::DeviceEnvelope::kInputReport:
        TakeReport(connection, received_ns, envelope_.input_report());
        return;
      case v1::DeviceEnvelope::kFault:
        Detach(connection, envelope_.fault().slot(),
               "read failed with error " + std::to_string(envelope_.fault().error_number()));
        return;
      case v1::DeviceEnvelope::kDetach:
        Detach(connection, envelope_.detach().slot(), "detached");
        return;
      case v1::DeviceEnvelope::kHandFrame:
        if (handlers_.on_hands)
          handlers_.on_hands(received_ns, wire::FromProto(envelope_.hand_frame()));
        return;
      case v1::DeviceEnvelope::kReferenceFrame:
        if (handlers_.on_reference)
          handlers_.on_reference(received_ns, wire::FromProto(envelope_.reference_frame()));
        return;
      case v1::DeviceEnvelope::kContactFrame:
        if (handlers_.on_contacts)
          handlers_.on_contacts(received_ns, wire::FromProto(envelope_.contact_frame()));
        return;
      case v1::DeviceEnvelope::kOutput:
      case v1::DeviceEnvelope::kRefused:
        Refuse(connection, "outputs go the other way");
        return;
      case v1::DeviceEnvelope::BODY_NOT_SET:
        Refuse(connection, "a message is empty");
        return;
    }
  }

  void Attach(std::uint64_t id, Connection& connection, const v1::DeviceAttach& attach) {
    connection.link->Charge(kAttachCost);
    connection.refused_slots.erase(attach.slot());
    if (const std::string wrong = WhatIsWrong(attach); !wrong.empty()) {
      Refuse(connection, "cannot attach a device: " + wrong);
      return;
    }
    if (connection.slots.size() >= kMaxSlots || connection.slots.contains(attach.slot())) {
      Refuse(connection, "cannot attach a device: slot taken, or more than " +
                             std::to_string(kMaxSlots) + " devices");
      return;
    }
    const DeviceHandle device = new_handle_();
    connection.slots[attach.slot()] = device;
    places_[device] = {id, attach.slot()};
    if (const auto why = handlers_.on_attach(device, IdentityOf(attach)); !why.empty()) {
      RefuseDevice(connection, attach.slot(), why);
    }
  }

  /// The other devices of the connection go on.
  void RefuseDevice(Connection& connection, std::uint32_t slot, const std::string& why) {
    places_.erase(connection.slots.at(slot));
    connection.slots.erase(slot);
    if (connection.refused_slots.size() < kMaxSlots) connection.refused_slots.insert(slot);
    v1::DeviceEnvelope envelope;
    envelope.mutable_refused()->set_slot(slot);
    envelope.mutable_refused()->set_reason(why);
    connection.link->Send(envelope.SerializeAsString());
  }

  void TakeReport(Connection& connection, std::int64_t received_ns,
                  const v1::DeviceInputReport& input) {
    const auto slot = connection.slots.find(input.slot());
    if (connection.refused_slots.contains(input.slot())) return;
    if (slot == connection.slots.end()) {
      Refuse(connection, "a report of a slot with no device");
      return;
    }
    const std::string& report = input.report();
    IncomingReport incoming;
    incoming.received_ns = received_ns;
    incoming.bytes = {reinterpret_cast<const std::uint8_t*>(report.data()), report.size()};
    incoming.true_ns = input.true_ns();
    incoming.feature = input.feature();
    handlers_.on_report(slot->second, incoming);
  }

  void Detach(Connection& connection, std::uint32_t slot, const std::string& reason) {
    const auto found = connection.slots.find(slot);
    if (found == connection.slots.end()) return;
    const DeviceHandle device = found->second;
    connection.slots.erase(found);
    places_.erase(device);
    handlers_.on_detach(device, reason);
  }

  /// Ends a connection that does not keep to the protocol.
  void Refuse(Connection& connection, const std::string& why) {
    handlers_.on_trouble("device socket: " + why + "; connection closed");
    connection.closing = true;
    while (!connection.slots.empty()) Detach(connection, connection.slots.begin()->first, why);
    connection.link->Finish({}, why);
  }

  void OnClose(std::uint64_t id, const std::string& reason) {
    Connection& connection = connections_.at(id);
    while (!connection.slots.empty()) {
      Detach(connection, connection.slots.begin()->first, "simulated device is gone: " + reason);
    }
    connections_.erase(id);
  }

  boost::asio::io_context& io_;
  transport::Address address_;
  std::function<DeviceHandle()> new_handle_;
  SourceHandlers handlers_;
  std::unique_ptr<transport::Listener> listener_;
  std::map<std::uint64_t, Connection> connections_;
  std::map<DeviceHandle, Place> places_;
  std::uint64_t last_connection_ = 0;
  timer::Timer idle_check_;
  transport::SharedLoop loop_;
  v1::DeviceEnvelope envelope_;
};

SocketSource::SocketSource(boost::asio::io_context& io, const transport::Address& address,
                           std::function<DeviceHandle()> new_handle, SourceHandlers handlers)
    : implementation_(std::make_unique<Implementation>(io, address, std::move(new_handle),
                                                       std::move(handlers))) {}

SocketSource::~SocketSource() = default;

Result<void> SocketSource::Start() { return implementation_->Start(); }

void SocketSource::Send(DeviceHandle device, const reports::OutputReport& report) {
  implementation_->Send(device, report);
}

void SocketSource::RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
  implementation_->RequestFeature(device, id, size);
}

void SocketSource::Stop() { implementation_->Stop(); }

}  // namespace footing::devices
