#include "daemon/sensor/reports/gyroscope_bias.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::calibration {

void GyroscopeBias::Begin(std::int64_t sampled_ns) {
  samples_ = 0;
  first_ns_ = sampled_ns;
  newest_ns_ = sampled_ns;
  mean_radps_.setZero();
  squares_radps2_.setZero();
}

void GyroscopeBias::Take(std::int64_t sampled_ns, const Eigen::Vector3d& specific_force_mps2,
                         const Eigen::Vector3d& angular_velocity_radps) {
  if (samples_ == 0 || sampled_ns < newest_ns_ ||
      sampled_ns - newest_ns_ > SecondsToNanoseconds(kMaxGapS)) {
    Begin(sampled_ns);
  }
  const double force_error_mps2 = std::abs(specific_force_mps2.norm() - kStandardGravityMps2);
  // Written so that NaN is not still.
  const bool still = force_error_mps2 <= kMaxForceErrorMps2 && angular_velocity_radps.allFinite() &&
                     angular_velocity_radps.cwiseAbs().maxCoeff() <= kMaxBiasRadps;
  if (!still) {
    samples_ = 0;
    return;
  }
  // Welford's sums.
  ++samples_;
  newest_ns_ = sampled_ns;
  const Eigen::Vector3d before = angular_velocity_radps - mean_radps_;
  mean_radps_ += before / samples_;
  squares_radps2_ += before.cwiseProduct(angular_velocity_radps - mean_radps_);
  if (newest_ns_ - first_ns_ < SecondsToNanoseconds(kWindowS) || samples_ < kMinSamples) return;
  const double worst_variance = squares_radps2_.maxCoeff() / samples_;
  if (worst_variance <= kMaxDeviationRadps * kMaxDeviationRadps) {
    bias_radps_ = mean_radps_;
    known_ = true;
    estimated_ns_ = newest_ns_;
  }
  samples_ = 0;
}

}  // namespace footing::calibration
