#include "common/virtual/devices/kinect_errors.h"

#include <cmath>

namespace footing::virtual_sensors {

KinectErrors::KinectErrors(std::uint64_t seed) : random_(seed) {
  for (double& value : offset_m_) value = kOffsetM * random_.Normal();
}

void KinectErrors::Expose() {
  const double kept = std::exp(-kPeriodS / kOffsetChangesS);
  for (double& value : offset_m_) {
    value = kept * value + std::sqrt(1 - kept * kept) * kOffsetM * random_.Normal();
  }
}

Eigen::Vector3d KinectErrors::Measure(const Eigen::Vector3d& p_W_m, noise::Random& noise) const {
  Eigen::Vector3d measured_m = p_W_m + offset_m_;
  for (double& value : measured_m) value += kNoiseM * noise.Normal();
  return measured_m;
}

double KinectErrors::SdM() { return std::hypot(kNoiseM, kOffsetM); }

}  // namespace footing::virtual_sensors
