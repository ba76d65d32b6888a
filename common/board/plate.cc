#include "common/board/plate.h"

namespace footing::board {

CornerForces operator-(const CornerForces& a, const CornerForces& b) {
  return {a.top_left_n - b.top_left_n, a.top_right_n - b.top_right_n,
          a.bottom_left_n - b.bottom_left_n, a.bottom_right_n - b.bottom_right_n};
}

double Total(const CornerForces& forces) {
  return forces.top_left_n + forces.top_right_n + forces.bottom_left_n + forces.bottom_right_n;
}

PlatePoint CentreOfPressure(const CornerForces& forces, double total_n,
                            const stream::BoardGeometry& geometry) {
  const double left = forces.top_left_n + forces.bottom_left_n;
  const double right = forces.top_right_n + forces.bottom_right_n;
  const double front = forces.top_left_n + forces.top_right_n;
  const double rear = forces.bottom_left_n + forces.bottom_right_n;
  return {geometry.sensor_distance_x_m / 2 * (right - left) / total_n,
          geometry.sensor_distance_y_m / 2 * (front - rear) / total_n};
}

PlateReading Plate::Advance(const CornerForces& forces) {
  PlateReading reading;
  reading.repeated = started_ && forces == last_;
  started_ = true;
  last_ = forces;

  const double left = forces.top_left_n + forces.bottom_left_n;
  const double right = forces.top_right_n + forces.bottom_right_n;
  reading.total_n = left + right;
  contact_ = reading.total_n > (contact_ ? config_.contact_off_n : config_.contact_on_n);
  reading.contact = contact_;
  reading.cop_valid = reading.total_n > config_.contact_off_n;
  if (reading.cop_valid) {
    const PlatePoint cop = CentreOfPressure(forces, reading.total_n, config_.geometry);
    reading.cop_x_m = cop.x_m;
    reading.cop_y_m = cop.y_m;
  }
  return reading;
}

}  // namespace footing::board
