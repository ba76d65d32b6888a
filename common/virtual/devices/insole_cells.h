#pragma once

#include <Eigen/Core>
#include <array>

#include "common/virtual/devices/body_course.h"
#include "common/virtual/devices/ground_reaction.h"

namespace footing::virtual_sensors {

/// A pressure insole: two columns of eight cells. Foot frame F: x from heel to ball, y left, origin
/// under the heel's middle.
inline constexpr std::size_t kInsoleCells = 16;

/// Where a sole is on the ground.
struct SolePlace {
  Eigen::Vector2d heel_m = Eigen::Vector2d::Zero();  ///< Middle of its heel, W.
  double yaw_rad = 0;                                ///< Of the ball from the heel.
  double length_m = 0;                               ///< From heel to ball.
};
SolePlace PlaceOfSole(const BodyCourse& course, std::size_t foot, Eigen::Index frame);

/// The cells' places in F for a sole of this length; they never move in the shoe.
std::array<Eigen::Vector2d, kInsoleCells> InsolePlaces(double length_m);

/// Loads of the cells under a foot, N: none pulls, they have the foot's load and its COP (moved to
/// where cells can have it, 5 mm inside of their outline), and are as even as these allow (greatest
/// entropy: each cell's share is an exponential of its place).
std::array<double, kInsoleCells> LoadInsole(
    const std::array<Eigen::Vector2d, kInsoleCells>& places_m, const SolePlace& sole,
    const FootForce& foot);

}  // namespace footing::virtual_sensors
