#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/device_models/controller.h"

namespace footing::device_models {

/// N on each sensor.
struct BoardForces {
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

  static constexpr std::uint16_t kVendor = 0x057e;
  static constexpr std::uint16_t kProduct = 0x0306;
  static constexpr const char* kName = "Nintendo RVL-WBC-01";
  static constexpr std::size_t kCorners = 4;  ///< Top right, bottom right, top left, bottom left.

  std::vector<Report> HandleOutput(std::span<const std::uint8_t> report) {
    return controller_.HandleOutput(report);
  }

  /// The report of one sample, when the mode calls for one; before the extension is switched to
  /// plain bytes they are of no use (FF).
  std::optional<Report> Sample(const BoardForces& forces, bool button = false);

  Controller& controller() { return controller_; }

  /// Counts at 0, 17 and 34 kg.
  using Points = std::array<int, 3>;
  const std::array<Points, kCorners>& points() const { return points_; }

 private:
  std::array<Points, kCorners> points_;
  Controller controller_;
};

}  // namespace footing::device_models
