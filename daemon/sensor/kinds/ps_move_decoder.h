#pragma once

#include <cstdint>
#include <optional>

#include "daemon/sensor/reports/move.h"
#include "daemon/sensor/kinds/decoded.h"
#include "daemon/sensor/reports/move_report.h"

namespace footing::ps_move {

/// A PS Move's input reports: a ZCM1's give two motion samples, half a report apart. A plain value.
class Decoder {
 public:
  explicit Decoder(reports::MoveModel model) : model_(model) {}

  /// None when it is not an input report of this model.
  std::optional<decode::Decoded> Take(const calibration::MoveCalibration& calibration,
                                      reports::Bytes report);

  /// 0 to 1; -1 while charging or unknown.
  double battery_fraction() const { return battery_fraction_; }

 private:
  reports::MoveModel model_;
  std::optional<reports::MoveSample> last_;
  std::uint32_t last_buttons_ = 0;
  double battery_fraction_ = -1;
};

}  // namespace footing::ps_move
