#pragma once

/// A Balance Board as a force plate: corner forces to total, centre of pressure and contact.
namespace footing::board {

/// Where the sensors are, and when somebody stands on them.
struct PlateConfig {
  double sensor_distance_x_m = 0.433;  ///< Left to right (Leach et al. 2014, Sensors 14:18244).
  double sensor_distance_y_m = 0.238;  ///< Rear to front.
  double contact_on_n = 68.6;          ///< 7 kg: over it there is contact.
  double contact_off_n = 49.0;         ///< 5 kg: under it there is none; above, the COP is defined.
};

/// N, upwards on the sensors positive. "Top" is the front edge, away from the power button.
struct CornerForces {
  double top_left_n = 0;
  double top_right_n = 0;
  double bottom_left_n = 0;
  double bottom_right_n = 0;

  bool operator==(const CornerForces&) const = default;
};

/// In the plate frame P: x to the right, y to the front, origin at the plate's middle.
struct PlateReading {
  double total_n = 0;
  bool cop_valid = false;
  double cop_x_m = 0;  ///< 0 while it is not valid, never NaN.
  double cop_y_m = 0;
  bool contact = false;
  bool repeated = false;  ///< Bit for bit the reading before: the board samples at about 60 Hz.
};

/// One board. A plain value.
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
