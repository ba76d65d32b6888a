#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/device_models/controller.h"
#include "common/device_models/identity.h"
#include "common/units/units.h"

namespace footing::device_models {

/// N on each sensor, under standard gravity: mass times 9.80665 m/s².
struct CornerForces {
  double top_left_n = 0;
  double top_right_n = 0;
  double bottom_left_n = 0;
  double bottom_right_n = 0;
};

/// A Balance Board: a Wiimote's radio with an extension that measures four corners. Its calibration
/// is drawn from the seed.
class BalanceBoard {
 public:
  explicit BalanceBoard(std::uint64_t seed);

  static constexpr std::uint8_t kReferenceTemperature = 0x19;
  static constexpr std::size_t kCorners = 4;  ///< Top right, bottom right, top left, bottom left.

  const Identity& identity() const { return identity_; }

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const CornerForces& forces, bool button = false);

  /// Raw byte 8, as the cells warm up: they then give more than the true load by 0.07 % a step
  /// above their temperature of calibration.
  void set_temperature(std::uint8_t raw) { temperature_ = raw; }
  /// Raw byte 10; four bars begin at 0x6a, 0x78, 0x7d, 0x82.
  void set_battery(std::uint8_t raw) { battery_ = raw; }
  /// Where the board stands: the cells feel weight, not mass.
  void set_gravity(double gravity_mps2) { gravity_mps2_ = gravity_mps2; }

  Controller& controller() { return controller_; }
  std::uint8_t leds() const { return controller_.leds(); }  ///< Bits 0 to 3.
  bool rumble() const { return controller_.rumble(); }

  /// Counts at 0, 17 and 34 kg.
  using Points = std::array<int, 3>;
  const std::array<Points, kCorners>& points() const { return points_; }

 private:
  std::array<Points, kCorners> points_;
  std::uint8_t temperature_ = kReferenceTemperature;
  std::uint8_t battery_ = 0x83;
  double gravity_mps2_ = kStandardGravityMps2;
  Identity identity_;
  Controller controller_;
};

}  // namespace footing::device_models
