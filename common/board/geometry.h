#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "common/stream/setup.h"

/// A Balance Board as a force plate: where its sensors are, what its corner forces mean, where
/// boards lie. Everything that knows a board's dimensions takes them from here.
namespace footing::board {

/// A board as it is built (Leach et al. 2014, Sensors 14:18244). footingd's config may state other
/// distances between the sensors, and publishes those in force with the layout.
inline constexpr stream::BoardGeometry kBalanceBoard{.plate_x_m = 0.511,
                                                     .plate_y_m = 0.316,
                                                     .sensor_distance_x_m = 0.433,
                                                     .sensor_distance_y_m = 0.238};
/// Of the plate's surface over the floor.
inline constexpr double kPlateHeightM = 0.053;

/// Total load above which somebody is in contact with a board, and below which nobody is: 7 and 5
/// kg. Above the lower one the COP is defined.
inline constexpr double kContactOnN = 68.6;
inline constexpr double kContactOffN = 49.0;

/// Range of a sensor distance and of a plate's side.
inline constexpr double kLeastLengthM = 0.1;
inline constexpr double kMostLengthM = 1;

/// Corners in the order top left, top right, bottom left, bottom right; "top" is the front edge,
/// away from the power button.
inline constexpr std::size_t kCorners = 4;
using Corners = std::array<double, kCorners>;
inline constexpr Corners kCornerRight{-1, 1, -1, 1};  ///< Signs in P.
inline constexpr Corners kCornerFront{1, 1, -1, -1};

/// Whether every length is finite and within its range.
bool IsSound(const stream::BoardGeometry& geometry);

/// The published geometry of a board, or a Balance Board's where none was published or it is not
/// sound.
stream::BoardGeometry GeometryOr(const std::optional<stream::BoardGeometry>& published);

/// A point of the plate frame P (x right, y front) in W. With yaw 0 the plate's front points
/// forward.
Eigen::Vector2d InWorld(const stream::BoardPose& pose, double right_m, double front_m);

/// The place of each corner's sensor in W.
std::array<Eigen::Vector2d, kCorners> SensorPlaces(
    const stream::BoardPose& pose, const stream::BoardGeometry& geometry = kBalanceBoard);

}  // namespace footing::board
