#pragma once

#include <hidapi/hidapi.h>

#include <memory>
#include <string>

#include "daemon/sensor/devices/node_monitor.h"
#include "daemon/sensor/devices/source.h"

namespace footing::devices {

/// Closes a device and gives up its lock.
struct HidClose {
  int lock = -1;
  void operator()(hid_device* device) const;
};
using HidHandle = std::unique_ptr<hid_device, HidClose>;

/// What became of opening a node.
struct HidOpening {
  enum class Outcome {
    kOpen,
    kUnidentified,  ///< udev does not know its serial yet.
    kDenied,        ///< EACCES: the udev rule is missing, or was not applied yet.
    kInUse,         ///< Another footingd holds it.
    kNobodyThere,   ///< An adapter's slot without a device.
    kFailed,
  };
  Outcome outcome = Outcome::kFailed;
  HidHandle device;
  DeviceIdentity identity;
  std::string reason;  ///< The kernel's words, of kFailed.
};

/// Opens the node and locks it against other instances of this program with flock(2), across users
/// and for as long as the handle lives. Blocks up to 0.2 s on a USB adapter's slot, which has to
/// answer first: the Mayflash DolphinBar shows four whether a Wiimote is there or not. A PS Move on
/// USB has the serial that it has over Bluetooth.
HidOpening OpenHid(const HidNode& node);

}  // namespace footing::devices
