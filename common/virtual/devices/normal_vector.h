#pragma once

#include <Eigen/Core>

#include "common/virtual/devices/random.h"

namespace footing::noise {

/// Three independent normal numbers of mean 0, drawn x first.
Eigen::Vector3d NormalVector(double sd, Random& random);

}  // namespace footing::noise
