#include "daemon/sensor/devices/hid_opening.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace footing::devices {
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

}  // namespace footing::devices
