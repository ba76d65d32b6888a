#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/extensions.h"
#include "common/virtual/devices/identity.h"

namespace footing::virtual_devices {

struct ProControllerSensors {
  GamepadSensors gamepad;   ///< Its triggers are switches: the bits of `buttons` alone count.
  bool left_stick = false;  ///< Pressed in.
  bool right_stick = false;
};

/// A Wii U Pro Controller: a Wiimote's radio with an extension of its own, which cannot be pulled.
class ProController {
 public:
  explicit ProController(std::uint64_t seed);

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const ProControllerSensors& sensors);

  /// 0 empty to 4 full.
  void set_battery(std::uint8_t level) { battery_ = level; }
  Controller& controller() { return controller_; }

 private:
  Identity identity_;
  Controller controller_;
  std::uint8_t battery_ = 4;
};

}  // namespace footing::virtual_devices
