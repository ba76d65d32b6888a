#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "common/base/units.h"
#include "common/body/body.h"
#include "common/virtual/devices/noise.h"
#include "common/virtual/motion/motion.h"

namespace footing::virtual_sensors {

/// True motion of a device on an arm or a belt, a column a frame, in its held frame S
/// (AsHeld of common/body/skeleton.h).
struct HeldCourse {
  Eigen::Matrix3Xd specific_force_S_mps2;
  Eigen::Matrix3Xd angular_velocity_S_radps;
};

/// In the middle of the fist of side 0 (left) or 1. Poses are smoothed first, since recorded ones
/// are not fit to be differentiated twice. The motion's skeleton is the body's.
HeldCourse FollowFist(const body::Body& body, const motion::Motion& motion, int side,
                      double cutoff_hz = 10);

/// Strapped halfway along the upper arm or forearm of a side, without errors of its mounting: in
/// the T-pose S's x points outwards, as the arm does, and z up.
enum class ArmSegment { kUpperArm, kForearm };
HeldCourse FollowSegment(const body::Body& body, const motion::Motion& motion, int side,
                         ArmSegment segment, double cutoff_hz = 10);

/// On the segment that turns with a joint, `beside_W_m` from the joint in the T-pose, without
/// errors of its mounting: in the T-pose S's x points forward and z up.
HeldCourse FollowJoint(const body::Body& body, const motion::Motion& motion, int joint,
                       const Eigen::Vector3d& beside_W_m, double cutoff_hz = 10);

/// Errors of a Wiimote with MotionPlus and of the hand that holds it; standard deviations unless
/// said otherwise. Noises, counts and ranges are the devices' (docs/hands.md).
struct HeldErrorConfig {
  double force_noise_mps2 = 0.06;
  double force_count_mps2 = kStandardGravityMps2 / 104;
  double force_range_mps2 = 3.6 * kStandardGravityMps2;  ///< Ends there.
  double force_bias_mps2 = 0.1;
  double turn_noise_radps = 0.006;
  double turn_count_radps = 0.00127;     ///< 595 degrees/s / 8192.
  double turn_bias_radps = 0.006;        ///< Constant; a rest can measure it.
  double turn_walk_radps_rt_s = 0.0003;  ///< The bias' random walk, after a second.
  double gain_spread = 0.01;             ///< Standard deviation of the gain of every axis of both.
  double grip_tilt_rad = 0.17;           ///< How it lies in the fist, about level axes,
  double grip_heading_rad = 0.07;        ///< and how far off it points in the T-pose.
  bool rolled = false;                   ///< Strapped with any turn about its x.
  std::uint64_t seed = 1;
};

/// One sample of a held device.
struct HeldReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< The accelerometer was at the end of its range.
};

/// One device with errors of its own, drawn from the seed.
class HeldErrors {
 public:
  explicit HeldErrors(const HeldErrorConfig& config);

  /// Errors of a perfect device, but for the end of the accelerometer's range.
  static HeldErrorConfig None();

  /// Reading for the truth, `step_s` after the reading before.
  HeldReading Advance(const Eigen::Vector3d& specific_force_mps2,
                      const Eigen::Vector3d& angular_velocity_radps, double step_s);

 private:
  HeldErrorConfig config_;
  noise::Random random_;
  Eigen::Matrix3d grip_;  ///< From the frame as it should be held.
  Eigen::Vector3d force_gain_, turn_gain_, force_bias_, turn_bias_;
};

}  // namespace footing::virtual_sensors
