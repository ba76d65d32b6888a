#pragma once

#include <memory>
#include <string>

#include "daemon/sensor/devices/source.h"

struct udev;
struct udev_monitor;

namespace footing::devices {

struct UdevRelease {
  void operator()(udev* context) const;
  void operator()(udev_monitor* monitor) const;
};

/// What udev knows of hidraw nodes: that something changed, and the driver behind one. Without a
/// running udev (a sandbox, a container) nothing is ever reported, and the nodes have to be looked
/// at from time to time.
class NodeMonitor {
 public:
  NodeMonitor();

  /// For poll(2); -1 when udev reports nothing here.
  int descriptor() const;
  /// Takes everything that was reported; true when there was something.
  bool Clear();
  struct Facts {
    std::string driver;  ///< The kernel's, e.g. "wiimote"; empty when unknown.
    Bus bus = Bus::kUnknown;
  };
  /// Of "/dev/hidrawN".
  Facts FactsOf(const std::string& path) const;

 private:
  std::unique_ptr<udev, UdevRelease> udev_;
  std::unique_ptr<udev_monitor, UdevRelease> monitor_;
};

}  // namespace footing::devices
