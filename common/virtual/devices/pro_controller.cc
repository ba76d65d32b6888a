#include "common/virtual/devices/pro_controller.h"

#include <algorithm>
#include <cmath>

namespace footing::virtual_devices {
namespace {

Memory MakeProMemory() {
  Memory memory(true);
  constexpr std::uint8_t kIdentity[] = {0x00, 0x00, 0xa4, 0x20, 0x01, 0x20};
  std::copy(std::begin(kIdentity), std::end(kIdentity), memory.extension().begin() + 0xfa);
  return memory;
}

/// 12 bits with 0x800 in the middle and 0x400 to either end.
void PutStick(double value, std::uint8_t* out) {
  const double finite = std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0;
  const int counts = 0x800 + static_cast<int>(std::round(finite * 0x400));
  out[0] = static_cast<std::uint8_t>(counts & 0xff);
  out[1] = static_cast<std::uint8_t>(counts >> 8);
}

}  // namespace

ProController::ProController(std::uint64_t seed) : controller_(MakeProMemory()) {
  identity_.product = stream::kProductTr;
  identity_.name = "Nintendo RVL-CNT-01-UC";
  identity_.serial = MakeSerial(SerialOf::kProController, seed);
}

std::optional<Report> ProController::Sample(const ProControllerSensors& sensors) {
  Readings readings;
  readings.extension.fill(0xff);
  if (controller_.memory().extension_plain()) {
    const GamepadSensors& pad = sensors.gamepad;
    readings.extension.fill(0);
    PutStick(pad.left_x, &readings.extension[0]);
    PutStick(pad.right_x, &readings.extension[2]);
    PutStick(pad.left_y, &readings.extension[4]);
    PutStick(pad.right_y, &readings.extension[6]);
    // Buttons are 0 when pressed. Byte 10: 1, battery, not on USB, not charging, sticks.
    const int released = ~static_cast<int>(pad.buttons);
    readings.extension[8] = static_cast<std::uint8_t>((released >> 8 & 0xff) | 1);
    readings.extension[9] = static_cast<std::uint8_t>(released & 0xff);
    readings.extension[10] = static_cast<std::uint8_t>(
        0x8c | battery_ << 4 | (sensors.left_stick ? 0 : 2) | (sensors.right_stick ? 0 : 1));
  }
  return controller_.DataReport(readings);
}

}  // namespace footing::virtual_devices
