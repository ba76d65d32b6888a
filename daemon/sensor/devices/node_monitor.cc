#include "daemon/sensor/devices/node_monitor.h"

#include <libudev.h>

namespace footing::devices {

void UdevRelease::operator()(udev* context) const { udev_unref(context); }
void UdevRelease::operator()(udev_monitor* monitor) const { udev_monitor_unref(monitor); }

NodeMonitor::NodeMonitor() : udev_(udev_new()) {
  if (!udev_) return;
  // Events as udevd sends them, after its rules have set owner and mode.
  monitor_.reset(udev_monitor_new_from_netlink(udev_.get(), "udev"));
  if (monitor_ &&
      (udev_monitor_filter_add_match_subsystem_devtype(monitor_.get(), "hidraw", nullptr) < 0 ||
       udev_monitor_enable_receiving(monitor_.get()) < 0)) {
    monitor_.reset();
  }
}

int NodeMonitor::descriptor() const { return monitor_ ? udev_monitor_get_fd(monitor_.get()) : -1; }

bool NodeMonitor::Clear() {
  bool any = false;
  while (monitor_) {
    udev_device* const device = udev_monitor_receive_device(monitor_.get());
    if (device == nullptr) break;
    any = true;
    udev_device_unref(device);
  }
  return any;
}

std::string NodeMonitor::DriverOf(const std::string& path) const {
  if (!udev_) return "";
  const std::string name = path.substr(path.rfind('/') + 1);
  udev_device* const node =
      udev_device_new_from_subsystem_sysname(udev_.get(), "hidraw", name.c_str());
  if (node == nullptr) return "";
  udev_device* const hid = udev_device_get_parent_with_subsystem_devtype(node, "hid", nullptr);
  const char* driver = hid == nullptr ? nullptr : udev_device_get_driver(hid);
  if (driver == nullptr && hid != nullptr) driver = udev_device_get_property_value(hid, "DRIVER");
  const std::string found = driver == nullptr ? "" : driver;
  udev_device_unref(node);
  return found;
}

}  // namespace footing::devices
