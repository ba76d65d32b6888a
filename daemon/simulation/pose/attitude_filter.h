#pragma once

#include <Eigen/Core>

#include "daemon/simulation/pose/low_pass.h"

namespace footing::arms {

/// One sample of a device in the fist, in its own frame S.
struct HandReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< The accelerometer was at the end of its range.
};

/// What is built into the filter; the defaults are VQF's (Laidig & Seel 2023, table 2).
struct AttitudeOptions {
  double gravity_s = 3;        ///< Time constant of the mean force.
  double frozen_s = 3;         ///< Without correction after a clipped reading; 0: not at all.
  bool bias_in_rest = true;    ///< Learn the gyroscope's bias while the device rests.
  bool bias_in_motion = true;  ///< And from the corrections while it moves.
  bool gain_in_motion = true;  ///< With the gains of the gyroscope's axes.
};

/// Orientation from gyroscope and accelerometer: the six-axis core of VQF (Laidig & Seel, "VQF:
/// highly accurate IMU orientation estimation with bias estimation and magnetic disturbance
/// rejection", Information Fusion 91, 2023). The specific force is low-passed in the frame that
/// the gyroscope alone keeps, where gravity stands still and accelerations cancel out; a Kalman
/// filter follows the gyroscope's bias, from the mean rate at rest and from the corrections in
/// motion. Departures: the same Kalman filter follows the gains of the gyroscope's axes; a clipped
/// accelerometer has no such mean, so correction and bias stay as they are for a while and the mean
/// restarts where gravity is believed to be; and deviations are estimated. Without a magnetometer
/// nothing corrects the heading. A value.
class AttitudeFilter {
 public:
  explicit AttitudeFilter(const AttitudeOptions& options = {}) : options_(options) {}

  /// Starts at heading 0 (S's x points forward; y where x is upright) with this mean force of a
  /// device at rest, m/s^2 and not zero, and this bias of the gyroscope, rad/s. `bias_sd_radps`:
  /// how well it is known.
  void Start(const Eigen::Vector3d& force_S_mps2, const Eigen::Vector3d& bias_S_radps,
             double bias_sd_radps);
  /// Non-finite readings are left out.
  void Advance(const HandReading& measured, double step_s);

  /// From S to W: z up, heading 0 at the start.
  Eigen::Matrix3d R_WS() const { return R_WG_ * R_GS_; }
  Eigen::Vector3d bias_S_radps() const { return start_bias_S_ + errors_.head<3>(); }
  /// Of each axis: by which part its reading is too large.
  Eigen::Vector3d gain_errors() const { return errors_.tail<3>(); }
  bool resting() const { return rest_s_ >= kRestS; }

  /// Standard deviations of the attitude: of the heading it grows from the start; of the
  /// inclination it grows while the correction is frozen.
  double heading_sd_rad() const;
  double inclination_sd_rad() const;

 private:
  static constexpr double kRestS = 1.5;
  using Errors = Eigen::Matrix<double, 6, 1>;  ///< Of the gyroscope: bias, rad/s; gains.
  using Jacobian = Eigen::Matrix<double, 3, 6>;

  bool Rests(const HandReading& reading, double step_s);
  void Integrate(const Eigen::Vector3d& turn_S, double step_s);
  void Correct(const HandReading& reading, double step_s);
  void FollowErrors(const Eigen::Vector3d& turn_S, const Eigen::Vector3d& lean_W, bool rests,
                    double step_s);
  Eigen::Vector3d Corrected(const Eigen::Vector3d& turn_S) const {
    return turn_S - errors_.head<3>() - errors_.tail<3>().cwiseProduct(turn_S);
  }
  void Spread(const HandReading& reading, double step_s);

  AttitudeOptions options_;
  Eigen::Matrix3d R_GS_ = Eigen::Matrix3d::Identity();  ///< G: kept by the gyroscope alone.
  Eigen::Matrix3d R_WG_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d start_bias_S_ = Eigen::Vector3d::Zero();  ///< Of any size; taken off at once.
  Errors errors_ = Errors::Zero();  ///< What is left of it, at most 2 deg/s each; the gains.
  Eigen::Matrix<double, 6, 6> variance_ = Eigen::Matrix<double, 6, 6>::Zero();  ///< Of errors_.
  LowPass<Eigen::Vector3d> force_G_;
  // The turn that errors_ make in W, as the mean force has seen it, and its derivative by them.
  LowPass<Eigen::Vector3d> turned_error_;
  LowPass<Jacobian> turned_;
  LowPass<Eigen::Vector3d> rest_force_S_, rest_turn_S_;
  double rest_s_ = 0, held_s_ = 0;
  double heading_drift_rad_ = 0, heading_noise_rad2_ = 0, heading_turned_rad_ = 0;
  double frozen_drift_rad_ = 0;
};

}  // namespace footing::arms
