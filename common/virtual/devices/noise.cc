#include "common/virtual/devices/noise.h"

namespace footing::noise {

double Random::Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }

double Random::Normal() {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += Uniform();
  return sum;
}

Eigen::Vector3d NormalVector(double sd, Random& random) {
  Eigen::Vector3d values;
  for (double& value : values) value = sd * random.Normal();
  return values;
}

}  // namespace footing::noise
