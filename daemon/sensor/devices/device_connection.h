#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <set>

#include "common/net/framed_connection.h"
#include "common/net/peer.h"
#include "daemon/sensor/devices/source.h"

namespace footing::devices {

/// A connection to the device socket, and what it has attached.
struct Connection {
  std::unique_ptr<transport::FramedConnection> link;
  transport::Peer peer;
  std::map<std::uint32_t, DeviceHandle> slots;
  std::set<std::uint32_t> refused_slots;
  std::int64_t heard_ns = 0;
  bool closing = false;
  bool is_newer = false;  ///< It has sent what this version does not know.
};

/// Where a device is attached.
struct Place {
  std::uint64_t connection;
  std::uint32_t slot;
};

}  // namespace footing::devices
