#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace footing::calibration {

/// What a gyroscope reads at rest, estimated again whenever the device lies still.
///
/// Still: for a whole window the specific force is near 1 g and the angular velocity hardly varies
/// and is within what a bias can be. The window's mean is the bias then; otherwise the last one
/// stays. A turn at a slow constant rate about the vertical looks the same; nobody's hand does
/// that.
class GyroscopeBias {
 public:
  static constexpr double kWindowS = 1;
  static constexpr int kMinSamples = 20;
  static constexpr double kMaxGapS = 0.25;            ///< A longer one restarts the window.
  static constexpr double kMaxForceErrorMps2 = 0.6;   ///< Of | |f| - g |, each sample.
  static constexpr double kMaxDeviationRadps = 0.02;  ///< Standard deviation of each axis.
  /// An uncalibrated MotionPlus is 300 counts off, 16 degrees/s in the slow range.
  static constexpr double kMaxBiasRadps = 0.6;

  /// One sample, both vectors in the same frame. Samples that are not finite or go back in time
  /// restart the window.
  void Take(std::int64_t sampled_ns, const Eigen::Vector3d& specific_force_mps2,
            const Eigen::Vector3d& angular_velocity_radps);

  /// To be taken off; zero as long as the device has not been still.
  const Eigen::Vector3d& bias_radps() const { return bias_radps_; }
  bool known() const { return known_; }
  /// Of the newest estimate.
  std::optional<std::int64_t> estimated_ns() const {
    return known_ ? std::optional(estimated_ns_) : std::nullopt;
  }

 private:
  void Begin(std::int64_t sampled_ns);

  Eigen::Vector3d bias_radps_ = Eigen::Vector3d::Zero();
  bool known_ = false;
  std::int64_t estimated_ns_ = 0;

  // The window under way.
  int samples_ = 0;
  std::int64_t first_ns_ = 0;
  std::int64_t newest_ns_ = 0;
  Eigen::Vector3d mean_radps_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares_radps2_ = Eigen::Vector3d::Zero();  // Of what differs from the mean.
};

}  // namespace footing::calibration
