#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "common/net/address.h"
#include "daemon/sensor/devices/connection_limits.h"
#include "daemon/sensor/devices/source.h"

namespace footing::devices {

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

}  // namespace footing::devices
