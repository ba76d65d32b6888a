#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <sys/types.h>
#include <boost/asio/io_context.hpp>

#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/limits.h"
#include "daemon/sensor/devices/source.h"
#include "daemon/sensor/reports/output_report.h"

namespace footing::devices {

/// Limits of one connection: of its messages, and of those that wait for it.
transport::FramedLimits LimitsOfOne();

/// How many connections the device socket has at once: settings of footingd. The server's own user
/// and root have places of their own beyond `max_connections`.
struct ConnectionLimits {
  std::int64_t max_connections = 64;
  /// Limit for one user; all connections over TCP count as one user's.
  std::int64_t max_connections_per_user = 16;
};

/// The connections that there are, those being refused not counted.
struct ConnectionCounts {
  std::int64_t all = 0;
  std::int64_t of_user = 0;  ///< Connections of the user that comes now.

  void Add(const transport::Peer& there, const transport::Peer& comes);
};

/// Why one more connection of this peer is refused; empty when it is taken.
std::string WhyNoConnection(const ConnectionLimits& limits, const transport::Peer& peer,
                            uid_t own_user, const ConnectionCounts& taken);

/// The device socket: device simulators dial it and speak DeviceEnvelopes, at most 2 KiB each, many
/// devices a connection. A connection beyond the limits hears why. One that says something
/// senseless is closed with one line; no other connection notices. Hand and reference frames need
/// no device; they are passed on unchecked.
class SocketSource : public DeviceSource {
 public:
  static constexpr std::size_t kMaxSlots = 16;  ///< Devices of one connection.

  /// `new_handle` gives numbers that no other source has given.
  SocketSource(boost::asio::io_context& io, const transport::Address& address,
               std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
               const ConnectionLimits& limits = {});
  ~SocketSource() override;

  Result<void> Start() override;
  /// Where it listens, once started.
  transport::Address address() const;
  void Send(DeviceHandle device, const reports::OutputReport& report) override;
  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) override;
  void Refuse(DeviceHandle device, const std::string& why) override;
  void Stop() override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// How a SessionSource reaches its sessions: transport::Server.
struct SessionLink {
  std::function<void(std::uint64_t session, const v1::DeviceEnvelope&)> send;
  std::function<void(std::uint64_t session, const std::string& why)> end;
};

/// Devices of other hosts: the messages of the device socket, within sessions that the server has
/// let in with the role control. Stamps by the sender's clock are ignored, which is not footingd's.
class SessionSource : public DeviceSource {
 public:
  SessionSource(std::function<DeviceHandle()> new_handle, SourceHandlers handlers,
                const SessionLink& link);
  ~SessionSource() override;

  Result<void> Start() override { return {}; }
  void Take(std::uint64_t session, std::int64_t received_ns, const v1::DeviceEnvelope& message);
  /// Detaches the devices of a session that has ended, if it had any.
  void EndSession(std::uint64_t session);
  void Send(DeviceHandle device, const reports::OutputReport& report) override;
  void RequestFeature(DeviceHandle device, std::uint8_t id, std::size_t size) override;
  void Refuse(DeviceHandle device, const std::string& why) override;
  void Stop() override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace footing::devices
