#include "common/board/geometry.h"

#include <cmath>

namespace footing::board {

bool IsSound(const stream::BoardGeometry& geometry) {
  // False for what is not a number, too.
  const auto within = [](double length_m) {
    return length_m >= kLeastLengthM && length_m <= kMostLengthM;
  };
  return within(geometry.plate_x_m) && within(geometry.plate_y_m) &&
         within(geometry.sensor_distance_x_m) && within(geometry.sensor_distance_y_m);
}

stream::BoardGeometry GeometryOr(const std::optional<stream::BoardGeometry>& published) {
  return published && IsSound(*published) ? *published : kBalanceBoard;
}

Eigen::Vector2d InWorld(const stream::BoardPose& pose, double right_m, double front_m) {
  const double c = std::cos(pose.yaw_rad), s = std::sin(pose.yaw_rad);
  return {pose.x_m + right_m * s + front_m * c, pose.y_m - right_m * c + front_m * s};
}

std::array<Eigen::Vector2d, kCorners> SensorPlaces(const stream::BoardPose& pose,
                                                   const stream::BoardGeometry& geometry) {
  std::array<Eigen::Vector2d, kCorners> places;
  for (std::size_t i = 0; i < kCorners; ++i) {
    places[i] = InWorld(pose, 0.5 * kCornerRight[i] * geometry.sensor_distance_x_m,
                        0.5 * kCornerFront[i] * geometry.sensor_distance_y_m);
  }
  return places;
}

}  // namespace footing::board
