#pragma once

#include "common/board/geometry.h"

namespace footing::board {

/// Where the sensors are, and when somebody stands on them.
struct PlateConfig {
  stream::BoardGeometry geometry = kBalanceBoard;
  double contact_on_n = kContactOnN;
  double contact_off_n = kContactOffN;
};

/// N, upwards on the sensors positive.
struct CornerForces {
  double top_left_n = 0;
  double top_right_n = 0;
  double bottom_left_n = 0;
  double bottom_right_n = 0;

  bool operator==(const CornerForces&) const = default;
};

/// Nothing is clamped: forces below zero after a tare are as true as those above.
CornerForces operator-(const CornerForces& a, const CornerForces& b);

double Total(const CornerForces& forces);

/// Centre of pressure in the plate frame P, m.
struct PlatePoint {
  double x_m = 0;
  double y_m = 0;
};

/// COP of forces with this total, which is not 0: x = dx/2 (right - left) / total,
/// y = dy/2 (front - rear) / total, with the distances between the sensors.
PlatePoint CentreOfPressure(const CornerForces& forces, double total_n,
                            const stream::BoardGeometry& geometry);

/// In the plate frame P.
struct PlateReading {
  double total_n = 0;
  bool cop_valid = false;
  double cop_x_m = 0;  ///< 0 while it is not valid, never NaN.
  double cop_y_m = 0;
  bool contact = false;
  bool repeated = false;  ///< Bit for bit the reading before: the board samples at about 60 Hz.
};

/// One board as a force plate: corner forces to total, centre of pressure and contact. A plain
/// value.
class Plate {
 public:
  explicit Plate(const PlateConfig& config = {}) : config_(config) {}

  /// Takes the next sample. The forces must be finite.
  PlateReading Advance(const CornerForces& forces);

 private:
  PlateConfig config_;
  bool started_ = false;
  bool contact_ = false;
  CornerForces last_;
};

}  // namespace footing::board
