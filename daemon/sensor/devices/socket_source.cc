#include "daemon/sensor/devices/socket_source.h"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include <google/protobuf/unknown_field_set.h>
#include <unistd.h>

#include "common/base/units.h"
#include "common/net/framing.h"
#include "common/net/listener.h"
#include "common/net/turn_queue.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "common/wire/wire.h"
#include "daemon/sensor/devices/source.h"
#include "footing/v1/device.pb.h"

namespace footing::devices {
namespace {

constexpr std::int64_t kAdminPlaces = 8;
/// 16 devices of 200 reports a second take two thirds.
constexpr transport::InputBudget kBudget = {5000, 5000, 1 << 20, 1 << 20};

}  // namespace

transport::FramedLimits LimitsOfOne() {
  transport::FramedLimits limits;
  limits.max_in_bytes = transport::kMaxDeviceBytes;
  limits.max_out_bytes = transport::kMaxDeviceBytes;
  limits.max_queued_bytes = 64 * transport::kMaxDeviceBytes;
  limits.input = kBudget;
  return limits;
}

void ConnectionCounts::Add(const transport::Peer& there, const transport::Peer& comes) {
  ++all;
  if (there.known == comes.known && there.user == comes.user) ++of_user;
}

std::string WhyNoConnection(const ConnectionLimits& limits, const transport::Peer& peer,
                            uid_t own_user, const ConnectionCounts& taken) {
  const bool admin = peer.known && (peer.user == own_user || peer.user == 0);
  const std::int64_t places = limits.max_connections + (admin ? kAdminPlaces : 0);
  if (taken.all >= places) {
    return "the device socket has " + std::to_string(taken.all) +
           " connections already (max_device_connections); end one, or attach more devices over it";
  }
  if (admin || taken.of_user < limits.max_connections_per_user) return "";
  return "the device socket has " + std::to_string(taken.of_user) + " connections " +
         (peer.known ? "of this user" : "over TCP") +
         " already (max_device_connections_per_user); end one, or attach more devices over it";
}

namespace {

constexpr double kAttachCost = 100;      // In messages: it rebuilds a rig, and reads a calibration.
constexpr std::size_t kMaxClosing = 16;  // Further ones that are being refused hear nothing.
constexpr auto kIdleCheckInterval = std::chrono::seconds(1);
constexpr std::int64_t kIdleNs = 10 * kNanosecondsPerSecond;

v1::DeviceEnvelope OutputMessage(std::uint32_t slot, const reports::OutputReport& report) {
  v1::DeviceEnvelope envelope;
  v1::DeviceOutput& output = *envelope.mutable_output();
  output.set_slot(slot);
  output.set_channel(v1::DeviceOutput::CHANNEL_INTERRUPT);
  output.set_report(report.data(), report.size());
  return envelope;
}

v1::DeviceEnvelope FeatureRequestMessage(std::uint32_t slot, std::uint8_t id, std::size_t size) {
  v1::DeviceEnvelope envelope;
  v1::DeviceOutput& output = *envelope.mutable_output();
  output.set_slot(slot);
  output.set_channel(v1::DeviceOutput::CHANNEL_FEATURE_GET);
  output.set_report(&id, 1);
  output.set_size(static_cast<std::uint32_t>(size));
  return envelope;
}

v1::DeviceEnvelope RefusedMessage(std::uint32_t slot, const std::string& why) {
  v1::DeviceEnvelope envelope;
  envelope.mutable_refused()->set_slot(slot);
  envelope.mutable_refused()->set_reason(why);
  return envelope;
}

}  // namespace

/// How messages leave for a connection, and what it is.
struct Carrier {
  std::function<void(std::uint64_t connection, const v1::DeviceEnvelope&)> send;
  /// Ends a connection that does not keep to the protocol; its program gets the reason, too.
  std::function<void(std::uint64_t connection, const std::string& why)> refuse;
  bool sessions = false;  ///< Stamps by the clocks of their hosts do not count.
};

/// The devices of many connections, whatever carries their messages.
class Attachments {
 public:
  Attachments(std::function<DeviceHandle()> new_handle, SourceHandlers handlers, Carrier carrier)
      : new_handle_(std::move(new_handle)),
        handlers_(std::move(handlers)),
        carrier_(std::move(carrier)) {}

  const SourceHandlers& handlers() const { return handlers_; }
  bool HasDevice(std::uint64_t connection) const {
    const auto found = connections_.find(connection);
    return found != connections_.end() && !found->second.slots.empty();
  }

  /// A simulated device that does not read loses its outputs, as a device out of range does.
  void Send(DeviceHandle device, const reports::OutputReport& report) {
    const auto place = places_.find(device);
    if (place == places_.end()) return;
    carrier_.send(place->second.connection, OutputMessage(place->second.slot, report));
  }

  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
    const auto place = places_.find(device);
    if (place == places_.end()) return;
    carrier_.send(place->second.connection, FeatureRequestMessage(place->second.slot, id, size));
  }

  void Refuse(DeviceHandle device, const std::string& why) {
    const auto place = places_.find(device);
    if (place == places_.end()) return;
    const auto [connection, slot] = place->second;
    RefuseDevice(connection, slot, why);
  }

  void Take(std::uint64_t id, std::int64_t received_ns, const v1::DeviceEnvelope& message) {
    Attached& connection = connections_[id];
    switch (message.body_case()) {
      case v1::DeviceEnvelope::kAttach:
        return Attach(id, connection, message.attach());
      case v1::DeviceEnvelope::kInputReport:
        return TakeReport(id, connection, received_ns, message.input_report());
      case v1::DeviceEnvelope::kFault:
        return Detach(connection, message.fault().slot(),
                      "read failed with error " + std::to_string(message.fault().error_number()));
      case v1::DeviceEnvelope::kDetach:
        return Detach(connection, message.detach().slot(), "detached");
      case v1::DeviceEnvelope::kHandFrame:
        return Pass(handlers_.on_hands, received_ns, message.hand_frame());
      case v1::DeviceEnvelope::kReferenceFrame:
        return Pass(handlers_.on_reference, received_ns, message.reference_frame());
      case v1::DeviceEnvelope::kContactFrame:
        return Pass(handlers_.on_contacts, received_ns, message.contact_frame());
      case v1::DeviceEnvelope::kOutput:
      case v1::DeviceEnvelope::kRefused:
        return carrier_.refuse(id, "outputs go the other way");
      case v1::DeviceEnvelope::BODY_NOT_SET:
        return TakeUnknown(id, connection, message);
    }
  }

  /// The connection is over.
  void End(std::uint64_t id, const std::string& reason) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    Attached& connection = found->second;
    while (!connection.slots.empty()) Detach(connection, connection.slots.begin()->first, reason);
    connections_.erase(id);
  }

  void Stop() {
    connections_.clear();
    places_.clear();
  }

 private:
  /// Where a device is attached.
  struct Place {
    std::uint64_t connection;
    std::uint32_t slot;
  };

  /// Devices that a connection has attached.
  struct Attached {
    std::map<std::uint32_t, DeviceHandle> slots;
    std::set<std::uint32_t> refused_slots;
    bool is_newer = false;  ///< It has sent what this version does not know.
  };

  /// Messages that a later version has are left out; the rest of the connection goes on.
  void TakeUnknown(std::uint64_t id, Attached& connection, const v1::DeviceEnvelope& message) {
    if (message.GetReflection()->GetUnknownFields(message).empty()) {
      return carrier_.refuse(id, "a message is empty");
    }
    if (std::exchange(connection.is_newer, true)) return;
    handlers_.on_trouble(
        "device socket: a message of a kind that this footingd does not know is ignored, and so "
        "are all that follow; is the sender newer?");
  }

  void Pass(const auto& handler, std::int64_t received_ns, const auto& message) const {
    if (!handler) return;
    auto frame = wire::FromProto(message);
    if (carrier_.sessions) frame.sent_ns = 0;
    handler(received_ns, frame);
  }

  void Attach(std::uint64_t id, Attached& connection, const v1::DeviceAttach& attach) {
    connection.refused_slots.erase(attach.slot());
    std::string wrong = WhatIsWrong(attach);
    if (wrong.empty() && connection.slots.contains(attach.slot())) {
      wrong = "slot " + std::to_string(attach.slot()) + " is taken";
    } else if (wrong.empty() && connection.slots.size() >= SocketSource::kMaxSlots) {
      wrong = "a connection has at most " + std::to_string(SocketSource::kMaxSlots) + " devices";
    }
    if (!wrong.empty()) return carrier_.refuse(id, "cannot attach a device: " + wrong);
    const DeviceHandle device = new_handle_();
    connection.slots[attach.slot()] = device;
    places_[device] = {id, attach.slot()};
    DeviceIdentity identity = IdentityOf(attach);
    if (carrier_.sessions) {
      identity.place = "session " + std::to_string(id) + ", slot " + std::to_string(attach.slot());
    }
    if (const auto why = handlers_.on_attach(device, identity); !why.empty()) {
      RefuseDevice(id, attach.slot(), why);
    }
  }

  /// The other devices of the connection go on.
  void RefuseDevice(std::uint64_t id, std::uint32_t slot, const std::string& why) {
    Attached& connection = connections_.at(id);
    places_.erase(connection.slots.at(slot));
    connection.slots.erase(slot);
    if (connection.refused_slots.size() < SocketSource::kMaxSlots) {
      connection.refused_slots.insert(slot);
    }
    carrier_.send(id, RefusedMessage(slot, why));
  }

  void TakeReport(std::uint64_t id, const Attached& connection, std::int64_t received_ns,
                  const v1::DeviceInputReport& input) {
    const auto slot = connection.slots.find(input.slot());
    if (connection.refused_slots.contains(input.slot())) return;
    if (slot == connection.slots.end()) {
      return carrier_.refuse(id, "a report of a slot with no device");
    }
    const std::string& report = input.report();
    IncomingReport incoming;
    incoming.received_ns = received_ns;
    incoming.bytes = {reinterpret_cast<const std::uint8_t*>(report.data()), report.size()};
    incoming.true_ns = input.true_ns();
    incoming.feature = input.feature();
    handlers_.on_report(slot->second, incoming);
  }

  void Detach(Attached& connection, std::uint32_t slot, const std::string& reason) {
    const auto found = connection.slots.find(slot);
    if (found == connection.slots.end()) return;
    const DeviceHandle device = found->second;
    connection.slots.erase(found);
    places_.erase(device);
    handlers_.on_detach(device, reason);
  }

  std::function<DeviceHandle()> new_handle_;
  SourceHandlers handlers_;
  Carrier carrier_;
  std::map<std::uint64_t, Attached> connections_;
  std::map<DeviceHandle, Place> places_;
};

class SocketSource::Implementation {
 public:
  Implementation(boost::asio::io_context& io, const transport::Address& address,
                 std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
                 const ConnectionLimits& limits)
      : devices(std::move(new_handle), std::move(handlers),
                {[this](std::uint64_t id, const auto& message) {
                   connections_.at(id).link->Send(message.SerializeAsString());
                 },
                 [this](std::uint64_t id, const std::string& why) { Refuse(id, why); }}),
        io_(io),
        address_(address),
        limits_(limits),
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

  transport::Address address() const { return listener_->address(); }

  void Stop() {
    idle_check_.cancel();
    listener_.reset();
    connections_.clear();
    devices.Stop();
  }

  Attachments devices;

 private:
  struct Connection {
    std::unique_ptr<transport::FramedConnection> link;
    transport::Peer peer;
    std::int64_t heard_ns = 0;
    bool closing = false;
  };

  void Accept(transport::Socket socket) {
    const transport::Peer peer = transport::PeerOf(socket.native_handle());
    ConnectionCounts taken;
    std::size_t closing = 0;
    for (const auto& [id, other] : connections_) {
      if (other.closing) ++closing;
      if (!other.closing) taken.Add(other.peer, peer);
    }
    const std::string full = WhyNoConnection(limits_, peer, geteuid(), taken);
    if (!full.empty() && closing >= kMaxClosing) return;
    Connection& connection = Open(std::move(socket), peer);
    if (full.empty()) return;
    devices.handlers().on_trouble("a connection was refused: " + full);
    Close(connection, full);
  }

  Connection& Open(transport::Socket socket, const transport::Peer& peer) {
    const std::uint64_t id = ++last_connection_;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this, id](std::string_view payload) { OnFrame(id, payload); };
    handlers.on_bad_input = [this, id](const auto& why) { Refuse(id, why); };
    handlers.on_bytes = [this, id] { connections_.at(id).heard_ns = clock::MonotonicNs(); };
    handlers.on_close = [this, id](const std::string& reason) {
      devices.End(id, "simulated device is gone: " + reason);
      connections_.erase(id);
    };
    Connection& connection = connections_[id];
    connection.peer = peer;
    connection.heard_ns = clock::MonotonicNs();
    connection.link = std::make_unique<transport::FramedConnection>(
        std::move(socket), LimitsOfOne(), std::move(handlers), loop_);
    connection.link->Start();
    return connection;
  }

  void CheckIdleLater() {
    idle_check_.After(kIdleCheckInterval, [this] {
      CloseIdle(clock::MonotonicNs());
      CheckIdleLater();
    });
  }

  /// A connection without a device that sends nothing takes a place from others.
  void CloseIdle(std::int64_t now_ns) {
    for (auto& [id, connection] : connections_) {
      const bool idle = !devices.HasDevice(id) && now_ns - connection.heard_ns > kIdleNs;
      if (idle && !connection.closing) {
        Refuse(id, "a connection without a device sent nothing for 10 s");
      }
    }
  }

  void OnFrame(std::uint64_t id, std::string_view payload) {
    Connection& connection = connections_.at(id);
    if (connection.closing) return;
    const std::int64_t received_ns = connection.heard_ns;  // When it was read; its turn came later.
    if (!envelope_.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) {
      return Refuse(id, "a message is not a DeviceEnvelope");
    }
    if (envelope_.has_attach()) connection.link->Charge(kAttachCost);
    devices.Take(id, received_ns, envelope_);
  }

  void Refuse(std::uint64_t id, const std::string& why) {
    devices.handlers().on_trouble("device socket: " + why + "; connection closed");
    devices.End(id, why);
    Close(connections_.at(id), why);
  }

  static void Close(Connection& connection, const std::string& why) {
    connection.closing = true;
    connection.link->Finish(RefusedMessage(0, why).SerializeAsString(), why);
  }

  boost::asio::io_context& io_;
  transport::Address address_;
  const ConnectionLimits limits_;
  std::unique_ptr<transport::Listener> listener_;
  std::map<std::uint64_t, Connection> connections_;
  std::uint64_t last_connection_ = 0;
  timer::Timer idle_check_;
  transport::SharedLoop loop_;
  v1::DeviceEnvelope envelope_;
};

SocketSource::SocketSource(boost::asio::io_context& io, const transport::Address& address,
                           std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
                           const ConnectionLimits& limits)
    : implementation_(std::make_unique<Implementation>(io, address, std::move(new_handle),
                                                       std::move(handlers), limits)) {}

SocketSource::~SocketSource() = default;

Result<void> SocketSource::Start() { return implementation_->Start(); }

transport::Address SocketSource::address() const { return implementation_->address(); }

void SocketSource::Send(DeviceHandle device, const reports::OutputReport& report) {
  implementation_->devices.Send(device, report);
}

void SocketSource::RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
  implementation_->devices.RequestFeature(device, id, size);
}

void SocketSource::Refuse(DeviceHandle device, const std::string& why) {
  implementation_->devices.Refuse(device, why);
}

void SocketSource::Stop() { implementation_->Stop(); }

class SessionSource::Implementation {
 public:
  Implementation(std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
                 const SessionLink& link)
      : devices(std::move(new_handle), std::move(handlers),
                {link.send,
                 [this, end = link.end, send = link.send](std::uint64_t session,
                                                          const std::string& why) {
                   devices.handlers().on_trouble("devices of session " + std::to_string(session) +
                                                 ": " + why + "; it is ended");
                   devices.End(session, why);
                   send(session, RefusedMessage(0, why));
                   end(session, why);
                 },
                 true}) {}

  Attachments devices;
  bool stopped = false;
};

SessionSource::SessionSource(std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
                             const SessionLink& link)
    : implementation_(
          std::make_unique<Implementation>(std::move(new_handle), std::move(handlers), link)) {}

SessionSource::~SessionSource() = default;

void SessionSource::Take(std::uint64_t session, std::int64_t received_ns,
                         const v1::DeviceEnvelope& message) {
  if (!implementation_->stopped) implementation_->devices.Take(session, received_ns, message);
}

void SessionSource::EndSession(std::uint64_t session) {
  implementation_->devices.End(session, "simulated device is gone: its session has ended");
}

void SessionSource::Send(DeviceHandle device, const reports::OutputReport& report) {
  implementation_->devices.Send(device, report);
}

void SessionSource::RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) {
  implementation_->devices.RequestFeature(device, id, size);
}

void SessionSource::Refuse(DeviceHandle device, const std::string& why) {
  implementation_->devices.Refuse(device, why);
}

void SessionSource::Stop() {
  implementation_->stopped = true;
  implementation_->devices.Stop();
}

}  // namespace footing::devices
