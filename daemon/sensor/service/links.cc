#include "daemon/sensor/service/links.h"

#include <utility>

namespace footing::sensor {

void Links::Attach(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  attached_ = true;
  reason_.clear();
  handle_ = handle;
  identity_ = identity;
  second_.reset();
}

bool Links::AttachSecond(devices::DeviceHandle handle, const devices::DeviceIdentity& identity) {
  second_ = handle;
  second_identity_ = identity;
  if (identity.bus == devices::Bus::kUsb) return false;
  std::swap(*second_, handle_);
  std::swap(second_identity_, identity_);
  return true;
}

void Links::Detach(devices::DeviceHandle handle, const std::string& reason) {
  if (second_) {
    if (handle == handle_) {
      handle_ = *second_;
      identity_ = second_identity_;
    }
    second_.reset();
    return;
  }
  attached_ = false;
  reason_ = reason;
}

}  // namespace footing::sensor
