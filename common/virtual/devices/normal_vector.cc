#include "common/virtual/devices/normal_vector.h"

namespace footing::noise {

Eigen::Vector3d NormalVector(double sd, Random& random) {
  Eigen::Vector3d values;
  for (double& value : values) value = sd * random.Normal();
  return values;
}

}  // namespace footing::noise
