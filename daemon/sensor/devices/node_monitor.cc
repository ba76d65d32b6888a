#include "daemon/sensor/devices/node_monitor.h"

#include <libudev.h>

#include <cstdlib>

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

NodeMonitor::Facts NodeMonitor::FactsOf(const std::string& path) const {
  Facts facts;
  if (!udev_) return facts;
  const std::string name = path.substr(path.rfind('/') + 1);
  udev_device* const node =
      udev_device_new_from_subsystem_sysname(udev_.get(), "hidraw", name.c_str());
  if (node == nullptr) return facts;
  if (udev_device* hid = udev_device_get_parent_with_subsystem_devtype(node, "hid", nullptr)) {
    const char* driver = udev_device_get_driver(hid);
    if (driver == nullptr) driver = udev_device_get_property_value(hid, "DRIVER");
    if (driver != nullptr) facts.driver = driver;
    // "0003:0000057E:00000306": bus, vendor, product. hidapi knows no bus of a virtual device.
    const char* id = udev_device_get_property_value(hid, "HID_ID");
    const unsigned long bus = id == nullptr ? 0 : std::strtoul(id, nullptr, 16);
    if (bus == static_cast<unsigned long>(Bus::kUsb)) facts.bus = Bus::kUsb;
    if (bus == static_cast<unsigned long>(Bus::kBluetooth)) facts.bus = Bus::kBluetooth;
  }
  udev_device_unref(node);
  return facts;
}

}  // namespace footing::devices
