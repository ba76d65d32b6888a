#include "daemon/sensor/features/kalman_filter.h"

#include "common/base/units.h"

namespace footing::signal {
namespace {

/// The rate at which "rms change per second" is turned into a density, 1/s: the Wiimote's own.
constexpr double kNominalRateHz = 100;

}  // namespace

double KalmanFilter::MeasurementVariance() const {
  return config_.sensor_noise_mps2 * config_.sensor_noise_mps2 +
         config_.quantum_mps2 * config_.quantum_mps2 / 12.0;
}

void KalmanFilter::Start(std::int64_t sampled_ns, const Eigen::Vector3d& sample_mps2) {
  started_ = true;
  time_ns_ = sampled_ns;
  level_mps2_ = sample_mps2;
  slope_mps3_.setZero();
  covariance_ << MeasurementVariance(), 0, 0,
      config_.first_slope_sd_mps3 * config_.first_slope_sd_mps3;
}

void KalmanFilter::Predict(double dt_s) {
  level_mps2_ += dt_s * slope_mps3_;
  Eigen::Matrix2d a;
  a << 1, dt_s, 0, 1;
  const double density = config_.slope_change_mps4 * config_.slope_change_mps4 / kNominalRateHz;
  Eigen::Matrix2d process;
  process << dt_s * dt_s * dt_s / 3, dt_s * dt_s / 2, dt_s * dt_s / 2, dt_s;
  process *= density;
  covariance_ = (a * covariance_ * a.transpose() + process).eval();
}

void KalmanFilter::Correct(const Eigen::Vector3d& sample_mps2) {
  const Eigen::Vector3d innovation = sample_mps2 - level_mps2_;
  const double variance = covariance_(0, 0) + MeasurementVariance();
  if (variance <= 0) {
    level_mps2_ = sample_mps2;
    return;
  }
  const Eigen::Vector2d gain = covariance_.col(0) / variance;
  level_mps2_ += gain(0) * innovation;
  slope_mps3_ += gain(1) * innovation;
  covariance_ = (covariance_ - gain * covariance_.row(0)).eval();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

Eigen::Vector3d KalmanFilter::Advance(std::int64_t sampled_ns, const Eigen::Vector3d& sample_mps2) {
  if (!sample_mps2.allFinite()) return level_mps2_;
  const double dt_s = NanosecondsToSeconds(sampled_ns - time_ns_);
  if (!started_ || dt_s < 0 || dt_s > config_.longest_pause_s) {
    Start(sampled_ns, sample_mps2);
    return level_mps2_;
  }
  if (dt_s == 0) return level_mps2_;
  time_ns_ = sampled_ns;
  Predict(dt_s);
  Correct(sample_mps2);
  return level_mps2_;
}

}  // namespace footing::signal
