#pragma once

#include <Eigen/Core>

#include "common/stream/hands.h"

namespace footing::stream {

/// Of the position, m^2, in W.
inline Eigen::Matrix3d CovarianceOf(const HandSample& sample) {
  Eigen::Matrix3d covariance = sample.sd_m.cwiseAbs2().asDiagonal();
  covariance(0, 1) = covariance(1, 0) = sample.covariance_m2.x();
  covariance(0, 2) = covariance(2, 0) = sample.covariance_m2.y();
  covariance(1, 2) = covariance(2, 1) = sample.covariance_m2.z();
  return covariance;
}

}  // namespace footing::stream
