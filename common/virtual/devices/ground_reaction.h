#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/virtual/devices/body_course.h"

namespace footing::virtual_sensors {

/// The force of the ground on the body, a column a frame.
struct GroundReaction {
  Eigen::Matrix3Xd force_n;
  /// Where a vertical force and a shear on the ground make the body's moment. Valid where
  /// `supported`.
  Eigen::Matrix2Xd cop_m;
  /// False in flight: the vertical force is under 6 % of the weight.
  std::vector<bool> supported;
};

/// F = m (c'' + g), and the COP from L' = (p - c) x F (equation (1) of Ha, Bai & Liu 2011). In
/// flight the force of recorded motion is a little above or below zero; it is left so, since a
/// clipped one would give the body momentum that it never had.
GroundReaction React(const BodyCourse& course, double cutoff_hz = 10);

/// Vertical force and COP under one foot at one time.
struct FootForce {
  double load_n = 0;
  Eigen::Vector2d cop_m = Eigen::Vector2d::Zero();  ///< The sole's middle where there is no load.
};

/// Shares the reaction of one frame between the corners of both soles: forces that push only, that
/// make the total and the COP as well as soles of this size can, and that are as even as the
/// corners' heights allow (a corner 2.5 cm above the ground is e times more reluctant).
std::array<FootForce, kFeet> ShareBetweenFeet(const BodyCourse& course,
                                              const GroundReaction& reaction, Eigen::Index frame);

}  // namespace footing::virtual_sensors
