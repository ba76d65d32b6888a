#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/device_models/controller.h"
#include "common/device_models/identity.h"

namespace footing::device_models {

/// A Wiimote without extension: its calibration is drawn from the seed, as units differ.
class Wiimote {
 public:
  explicit Wiimote(std::uint64_t seed);

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one. `specific_force_S_mps2` in the sensor
  /// frame (x left, y front, z down; at rest face up (0, 0, -9.81)) is turned into counts by the
  /// device's own calibration and ends at the count range.
  std::optional<Report> Sample(const Eigen::Vector3d& specific_force_S_mps2,
                               std::uint16_t buttons = 0);

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }

  struct Axis {
    int zero_counts = 0x200;
    int one_g_counts = 0x268;
  };
  /// Raw axes x, y, z; what the EEPROM holds.
  const std::array<Axis, 3>& axes() const { return axes_; }

 private:
  std::array<Axis, 3> axes_;
  Identity identity_;
  Controller controller_;
};

}  // namespace footing::device_models
