#pragma once

#include <vector>

#include "clients/log/opensim.h"
#include "common/virtual/motion/c3d.h"
#include "common/virtual/motion/motion.h"

namespace footing::log_client {

/// A reconstructed body as a C3D file holds it: the centres of the joints as points, the forces
/// under the feet as two force plates. Axes: W (x ahead, y left, z up).
///
/// Plate 1 is the left foot, plate 2 the right one. Both are one rectangle of the floor that holds
/// all centres of pressure, and of type 2: three forces on the person and three moments about the
/// rectangle's middle, in axes x ahead, y right, z down. Only the vertical force and the moments
/// that it causes are known; the others are 0. The points of a frame that is not `valid` are not
/// seen.
motion::C3d ToC3d(const motion::Motion& motion, const std::vector<bool>& valid,
                  const std::vector<FootForces>& forces);

}  // namespace footing::log_client
