#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/virtual/devices/random.h"

namespace footing::virtual_sensors {

/// Errors of points as a Kinect's skeleton tracker reports them (docs/hands.md): white noise, and
/// an offset common to all of them that changes slowly. It sees 30 frames a second and reports each
/// two frames late.
class KinectErrors {
 public:
  static constexpr double kPeriodS = 1.0 / 30, kLateS = 2.0 / 30;
  static constexpr double kNoiseM = 0.015, kOffsetM = 0.04, kOffsetChangesS = 5;

  explicit KinectErrors(std::uint64_t seed);

  /// The next exposure, kPeriodS after the one before.
  void Expose();
  /// A hand of this exposure where it is reported; the left one first.
  Eigen::Vector3d Measure(const Eigen::Vector3d& p_W_m) { return Measure(p_W_m, random_); }
  /// Another point of it, with noise from elsewhere.
  Eigen::Vector3d Measure(const Eigen::Vector3d& p_W_m, noise::Random& noise) const;
  /// Along each axis, of all errors.
  static double SdM();

 private:
  noise::Random random_;
  Eigen::Vector3d offset_m_;
};

}  // namespace footing::virtual_sensors
