#include "daemon/sensor/board/plate.h"

namespace footing::board {

PlateReading Plate::Advance(const CornerForces& forces) {
  PlateReading reading;
  reading.repeated = started_ && forces == last_;
  started_ = true;
  last_ = forces;

  const double left = forces.top_left_n + forces.bottom_left_n;
  const double right = forces.top_right_n + forces.bottom_right_n;
  const double front = forces.top_left_n + forces.top_right_n;
  const double rear = forces.bottom_left_n + forces.bottom_right_n;
  reading.total_n = left + right;
  contact_ = reading.total_n > (contact_ ? config_.contact_off_n : config_.contact_on_n);
  reading.contact = contact_;
  reading.cop_valid = reading.total_n > config_.contact_off_n;
  if (reading.cop_valid) {
    reading.cop_x_m = config_.sensor_distance_x_m / 2 * (right - left) / reading.total_n;
    reading.cop_y_m = config_.sensor_distance_y_m / 2 * (front - rear) / reading.total_n;
  }
  return reading;
}

}  // namespace footing::board
