#include "daemon/sensor/devices/source.h"

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <libudev.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/stream/product_ids.h"

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

namespace {

using Outcome = HidOpening::Outcome;

constexpr int kAnswerMs = 200;
constexpr std::uint8_t kMoveAddressFeature = 0x04;
constexpr std::size_t kMoveAddressBytes = 16;  // psmoveapi's PSMOVE_BTADDR_GET_SIZE.

DeviceIdentity Describe(const HidNode& node) {
  DeviceIdentity identity;
  identity.bus = node.bus;
  identity.driver = node.driver;
  identity.vendor = node.vendor;
  identity.product = node.product;
  identity.name = node.name;
  identity.serial = node.serial;
  identity.place = node.path;
  return identity;
}

/// A slot of a USB adapter refuses the write (EPIPE) or never answers when it is empty.
bool Answers(hid_device* device) {
  constexpr std::uint8_t kRequestStatus[] = {0x15, 0x00};
  if (hid_write(device, kRequestStatus, sizeof(kRequestStatus)) < 0) return false;
  std::uint8_t report[64];
  return hid_read_timeout(device, report, sizeof(report), kAnswerMs) > 0;
}

/// The Bluetooth address of a PS Move, read over USB; empty when it refuses.
std::string MoveSerial(hid_device* device) {
  std::uint8_t bytes[kMoveAddressBytes] = {kMoveAddressFeature};
  if (hid_get_feature_report(device, bytes, sizeof(bytes)) < 7) return "";
  char text[18];
  std::snprintf(text, sizeof(text), "%02x:%02x:%02x:%02x:%02x:%02x", bytes[6], bytes[5], bytes[4],
                bytes[3], bytes[2], bytes[1]);
  return text;
}

}  // namespace

void HidClose::operator()(hid_device* device) const {
  hid_close(device);
  if (lock >= 0) close(lock);
}

HidOpening OpenHid(const HidNode& node) {
  HidOpening opening;
  opening.identity = Describe(node);
  // Over Bluetooth every device has an address; udev may still have to read it.
  if (opening.identity.bus == Bus::kBluetooth && opening.identity.serial.empty()) {
    opening.outcome = Outcome::kUnidentified;
    return opening;
  }
  // hidapi hides its descriptor, so the lock has its own. Nobody reads it: the kernel stops filling
  // its queue after 64 reports.
  const int lock = open(node.path.c_str(), O_RDWR | O_CLOEXEC);
  if (lock < 0) {
    opening.outcome = errno == EACCES || errno == EPERM ? Outcome::kDenied : Outcome::kFailed;
    opening.reason = std::strerror(errno);
    return opening;
  }
  opening.device.get_deleter().lock = lock;
  if (flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(lock);
    opening.outcome = Outcome::kInUse;
    return opening;
  }
  opening.device.reset(hid_open_path(node.path.c_str()));
  if (!opening.device) {
    opening.reason = std::strerror(errno);
    close(lock);
    return opening;
  }
  const bool usb = opening.identity.bus == Bus::kUsb;
  if (usb && node.vendor == kVendorNintendo && !Answers(opening.device.get())) {
    opening.device.reset();
    opening.outcome = Outcome::kNobodyThere;
    return opening;
  }
  if (usb && node.vendor == kVendorSony) {
    const std::string serial = MoveSerial(opening.device.get());
    if (!serial.empty()) opening.identity.serial = serial;
  }
  if (opening.identity.serial.empty()) opening.identity.serial = node.path;
  opening.outcome = Outcome::kOpen;
  return opening;
}

namespace {

constexpr std::size_t kMaxTextBytes = 64;

/// Names and serials go to screens and files: short, and of printable ASCII.
bool IsPlainText(const std::string& text) {
  if (text.size() > kMaxTextBytes) return false;
  for (const char c : text) {
    if (c < ' ' || c > '~') return false;
  }
  return true;
}

stream::DeviceRole RoleOf(v1::DeviceRole role) {
  return v1::DeviceRole_IsValid(role) ? static_cast<stream::DeviceRole>(role)
                                      : stream::DeviceRole::kUnspecified;
}

}  // namespace

std::string WhatIsWrong(const v1::DeviceAttach& attach) {
  if (!stream::IsKnownDevice(attach.vendor(), attach.product()) &&
      !stream::IsInertialSensor(attach.vendor(), attach.product())) {
    return "vendor " + std::to_string(attach.vendor()) + " and product " +
           std::to_string(attach.product()) +
           " are unknown; the protocol lists those of all devices";
  }
  if (attach.serial().empty()) return "serial is empty";
  if (!IsPlainText(attach.serial()) || !IsPlainText(attach.name()) || !IsPlainText(attach.rig())) {
    return "serial, name or rig is not short printable text";
  }
  return "";
}

DeviceIdentity IdentityOf(const v1::DeviceAttach& attach) {
  DeviceIdentity identity;
  identity.bus =
      attach.bus() == static_cast<std::uint32_t>(Bus::kUsb) ? Bus::kUsb : Bus::kBluetooth;
  identity.vendor = attach.vendor();
  identity.product = attach.product();
  identity.name = attach.name();
  identity.serial = attach.serial();
  identity.place = "device socket, slot " + std::to_string(attach.slot());
  // Only a sensor whose reports are ours can be hardware behind this socket.
  identity.simulated =
      !(attach.hardware() && stream::IsInertialSensor(attach.vendor(), attach.product()));
  identity.wished_rig = attach.rig();
  identity.wished_role = RoleOf(attach.role());
  return identity;
}

}  // namespace footing::devices
