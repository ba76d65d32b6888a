#pragma once

#include <Eigen/Core>
#include <array>

#include "common/body/body.h"
#include "common/virtual/motion/motion.h"

/// What sensors under a moving body would measure: forces and centres of pressure by inverse
/// dynamics, the cells of two boards with their limits and errors.
namespace footing::virtual_sensors {

inline constexpr int kFeet = 2;  ///< 0 is the left one.
inline constexpr int kFootPoints = 4;

/// A body in motion, as far as the ground feels it; a column a frame. In W, z = 0 is the ground.
struct BodyCourse {
  double rate_hz = 0;
  double mass_kg = 0;
  Eigen::Matrix3Xd com_m;
  Eigen::Matrix3Xd angular_momentum;  ///< About the COM, kg m²/s.
  /// Corners of each sole: heel inside and outside, ball inside and outside. Heights are above
  /// those of a flat standing foot, so 0 where the corner carries.
  std::array<std::array<Eigen::Matrix3Xd, kFootPoints>, kFeet> sole_m;

  Eigen::Index frames() const { return com_m.cols(); }
};

/// Kinematics of every frame. Angles and position of the root are low-passed first (measured
/// positions are not fit to be differentiated twice). The motion's skeleton is the body's.
BodyCourse Follow(const body::Body& body, const motion::Motion& motion, double cutoff_hz = 6);

}  // namespace footing::virtual_sensors
