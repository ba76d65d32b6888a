#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/board/plate.h"
#include "common/virtual/devices/controller.h"
#include "common/virtual/devices/identity.h"

namespace footing::virtual_devices {

using board::CornerForces;

/// A Balance Board: a Wiimote's radio with an extension that measures four corners.
///
/// Its cells read more than their calibration says, by 1 / 0.99908, and 0.07 % more for each step
/// of its thermometer above the calibration's: what WiiBrew found, and what a host has to take off
/// again. They feel force: the mass that gives it depends on the place's gravity, and is the
/// host's.
class BalanceBoard {
 public:
  static constexpr std::size_t kCorners = 4;  ///< Top right, bottom right, top left, bottom left.
  /// Counts at 0, 17 and 34 kg.
  using Points = std::array<int, 3>;
  /// The thermometer's byte at calibration; 0x19 in the packet of a real one.
  static constexpr std::uint8_t kReferenceTemperature = 0x19;

  /// Its calibration is drawn from the seed.
  explicit BalanceBoard(std::uint64_t seed);
  /// With the calibration of a unit that is known.
  BalanceBoard(std::uint64_t seed, const std::array<Points, kCorners>& points);

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  std::vector<Report> HandleOutput(std::int64_t, std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const CornerForces& forces, bool button = false);

  void set_temperature(std::uint8_t raw) { temperature_ = raw; }
  /// Byte 10; bars begin at 0x6a, 0x78, 0x7d and 0x82. The status report's byte hardly changes.
  void set_battery(std::uint8_t raw) { battery_ = raw; }

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }

  const std::array<Points, kCorners>& points() const { return points_; }

 private:
  std::array<Points, kCorners> points_;
  Identity identity_;
  Controller controller_;
  std::uint8_t temperature_ = kReferenceTemperature;
  std::uint8_t battery_ = 0x83;  ///< Four bars.
};

}  // namespace footing::virtual_devices
