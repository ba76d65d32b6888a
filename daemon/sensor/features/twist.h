#pragma once

#include <Eigen/Core>

#include "daemon/sensor/features/config.h"
#include "daemon/sensor/features/sample_grid.h"

namespace footing::features {

/// The direction, of unit length, along which the means of the cycles of `steps` grid points spread
/// over the newest `points`: that in which gravity moves while a wrist twists. Zero when they
/// hardly spread, or when little of the swing is left across it.
Eigen::Vector3d FindTwist(const SampleGrid& grid, int points, double steps,
                          const CadenceConfig& config);

}  // namespace footing::features
