#pragma once

#include <memory>
#include <string>
#include <vector>

#include "daemon/sensor/devices/source.h"

struct udev;
struct udev_monitor;

namespace footing::devices {

struct UdevRelease {
  void operator()(udev* context) const;
  void operator()(udev_monitor* monitor) const;
};

/// A hidraw node as the kernel describes it.
struct HidNode {
  std::string path;  ///< "/dev/hidraw3"
  Bus bus = Bus::kUnknown;
  std::uint32_t vendor = 0;
  std::uint32_t product = 0;
  std::string name;    ///< Both may be empty for a moment after it appeared.
  std::string serial;  ///< Over Bluetooth the device's address.
  std::string driver;  ///< The kernel's, e.g. "wiimote"; empty when unknown.
};

/// What udev knows of hidraw nodes: that something changed, and which there are. Without a running
/// udev (a sandbox, a container) nothing is ever reported, and the nodes have to be looked at from
/// time to time.
class NodeMonitor {
 public:
  NodeMonitor();

  /// For poll(2); -1 when udev reports nothing here.
  int descriptor() const;
  /// Takes everything that was reported; true when there was something.
  bool Clear();
  /// Every node there is now. Not hid_enumerate: that of hidapi 0.13 crashes at a node that goes
  /// while it looks (strdup of an absent uevent), and opens every HID device of the machine.
  std::vector<HidNode> Nodes() const;

 private:
  std::unique_ptr<udev, UdevRelease> udev_;
  std::unique_ptr<udev_monitor, UdevRelease> monitor_;
};

}  // namespace footing::devices
