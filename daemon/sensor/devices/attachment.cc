#include "daemon/sensor/devices/attachment.h"

#include <cstddef>

#include "common/stream/product_ids.h"

namespace footing::devices {
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
  if (!stream::IsKnownDevice(attach.vendor(), attach.product())) {
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
  identity.simulated = true;
  identity.wished_rig = attach.rig();
  identity.wished_role = RoleOf(attach.role());
  return identity;
}

}  // namespace footing::devices
