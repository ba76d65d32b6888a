#include "daemon/sensor/devices/node_monitor.h"

#include <libudev.h>

#include <cstdio>
#include <optional>
#include <utility>

namespace footing::devices {
namespace {

/// The kernel's texts are ASCII in practice; what is not becomes '?'.
std::string Text(const char* text) {
  std::string plain = text == nullptr ? "" : text;
  for (char& c : plain) {
    if (c < ' ' || c > '~') c = '?';
  }
  return plain;
}

/// None while the kernel is still setting it up, or taking it down: any part may be missing.
std::optional<HidNode> Describe(udev_device* device) {
  const char* const path = device == nullptr ? nullptr : udev_device_get_devnode(device);
  if (path == nullptr) return std::nullopt;
  udev_device* const hid = udev_device_get_parent_with_subsystem_devtype(device, "hid", nullptr);
  // "0005:0000057E:00000306": bus, vendor, product.
  const char* const id = hid == nullptr ? nullptr : udev_device_get_property_value(hid, "HID_ID");
  unsigned bus = 0, vendor = 0, product = 0;
  if (id == nullptr || std::sscanf(id, "%x:%x:%x", &bus, &vendor, &product) != 3) {
    return std::nullopt;
  }
  HidNode node;
  node.path = path;
  if (bus == static_cast<unsigned>(Bus::kUsb)) node.bus = Bus::kUsb;
  if (bus == static_cast<unsigned>(Bus::kBluetooth)) node.bus = Bus::kBluetooth;
  node.vendor = vendor;
  node.product = product;
  node.name = Text(udev_device_get_property_value(hid, "HID_NAME"));
  node.serial = Text(udev_device_get_property_value(hid, "HID_UNIQ"));
  const char* driver = udev_device_get_driver(hid);
  if (driver == nullptr) driver = udev_device_get_property_value(hid, "DRIVER");
  node.driver = Text(driver);
  return node;
}

}  // namespace

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

std::vector<HidNode> NodeMonitor::Nodes() const {
  std::vector<HidNode> nodes;
  udev_enumerate* const enumeration = udev_ ? udev_enumerate_new(udev_.get()) : nullptr;
  if (enumeration == nullptr) return nodes;
  udev_enumerate_add_match_subsystem(enumeration, "hidraw");
  udev_enumerate_scan_devices(enumeration);
  for (udev_list_entry* entry = udev_enumerate_get_list_entry(enumeration); entry != nullptr;
       entry = udev_list_entry_get_next(entry)) {
    udev_device* const device =
        udev_device_new_from_syspath(udev_.get(), udev_list_entry_get_name(entry));
    if (auto node = Describe(device)) nodes.push_back(std::move(*node));
    udev_device_unref(device);
  }
  udev_enumerate_unref(enumeration);
  return nodes;
}

}  // namespace footing::devices
