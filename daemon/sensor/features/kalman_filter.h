#pragma once

#include <Eigen/Core>
#include <cstdint>

/// The Kalman filter that takes the noise off accelerations (gait paper, section 6: "We use a
/// Kalman filter to reduce noise [Rasco 2008]").
///
/// Rasco's filter is the plain discrete one: predict, then correct by the innovation. Each axis is
///   state   x = (level, slope)                    m/s², m/s³
///   predict x- = A x,      A = [1 dt; 0 1],       P- = A P A' + Q
///   correct x  = x- + K (z - level-),             K  = P- H' / (H P- H' + r),  H = (1 0)
/// The three axes have the same noise, so they share one P and one K. A filter of the level alone,
/// which the paper's name for it suggests, trails a swing by a sample or two.
namespace footing::signal {

/// Process and measurement noise of the filter.
struct KalmanConfig {
  /// ADXL330: 280 (x, y) to 350 (z) µg/√Hz over the 50 Hz band are 2.5 to 3.1 mg rms.
  double sensor_noise_mps2 = 0.0304;
  /// One count of the 8-bit reports, 38 mg; its rounding error is count / √12 rms.
  double quantum_mps2 = 0.373;

  /// How fast the slope may change, rms, in m/s⁴: that of a 2 Hz swing of 4.5 m/s² peak,
  /// (2π 2)² 4.5 / √2. Faster swings pull the level along by themselves; rounding steps do not.
  double slope_change_mps4 = 500;
  /// Slope at the start, rms, in m/s³: (2π 2) 4.5 / √2.
  double first_slope_sd_mps3 = 40;

  /// A longer pause than this restarts from the next sample.
  double longest_pause_s = 0.25;
};

/// One controller's three axes. A plain value; copy it to try something out.
class KalmanFilter {
 public:
  explicit KalmanFilter(const KalmanConfig& config = {}) : config_(config) {}

  /// The filtered specific force at `sampled_ns`, in the frame and unit of the sample (m/s²). The
  /// first sample, one after a pause and one from before the last pass through and restart it; one
  /// at the same instant, or one that is not finite, changes nothing.
  Eigen::Vector3d Advance(std::int64_t sampled_ns, const Eigen::Vector3d& sample_mps2);

 private:
  void Start(std::int64_t sampled_ns, const Eigen::Vector3d& sample_mps2);
  void Predict(double dt_s);
  void Correct(const Eigen::Vector3d& sample_mps2);
  double MeasurementVariance() const;

  KalmanConfig config_;
  bool started_ = false;
  std::int64_t time_ns_ = 0;
  Eigen::Vector3d level_mps2_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d slope_mps3_ = Eigen::Vector3d::Zero();
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
};

}  // namespace footing::signal
