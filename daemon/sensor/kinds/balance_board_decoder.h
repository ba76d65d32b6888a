#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/board/plate.h"
#include "common/base/units.h"
#include "daemon/sensor/reports/board.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/reports/extension.h"

namespace footing::balance_board {

/// A Balance Board's extension bytes to forces; watches for sensors that can't be right. A plain
/// value.
class Decoder {
 public:
  /// What one cell and the whole board are made for. More is passed on and said so.
  static constexpr double kCellRangeKg = 34;
  static constexpr double kTotalRangeKg = 150;
  /// A corner that stays on one count while the others change this often is stuck.
  static constexpr int kStuckChanges = 500;

  explicit Decoder(double local_gravity_mps2 = kStandardGravityMps2)
      : local_gravity_mps2_(local_gravity_mps2) {}

  /// None for reports that are too short for four corners.
  std::optional<decode::Decoded> Take(const calibration::BoardCalibration& calibration,
                                      reports::Bytes extension);

  /// 0 to 1 from byte 10; -1 until a report had it.
  double battery_fraction() const { return battery_fraction_; }
  bool battery_low() const { return battery_low_; }
  /// Which sensor is stuck or over its range in the newest report; empty when none.
  std::string Note() const;

 private:
  void Watch(const reports::BoardCounts& counts);

  double local_gravity_mps2_;
  bool started_ = false;
  std::array<std::uint16_t, reports::kCorners> last_{};
  std::array<int, reports::kCorners> still_{};  // Changes of other corners since this one changed.
  bool over_range_ = false;
  double battery_fraction_ = -1;
  bool battery_low_ = false;
};

}  // namespace footing::balance_board
