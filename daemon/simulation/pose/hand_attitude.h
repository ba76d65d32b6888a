#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace footing::arms {

/// A Butterworth low-pass of second order, of vectors or matrices. A value.
template <typename T>
class LowPass {
 public:
  /// At rest at this value.
  void Start(const T& value) { y1_ = y2_ = x1_ = x2_ = value; }

  /// `tau_s`: its step response is that of a critically damped mean over this time; the cutoff is
  /// sqrt(2) / (2 pi tau). `step_s` is far below it.
  const T& Advance(const T& value, double tau_s, double step_s) {
    const double c = std::tan(std::numbers::sqrt2 / (2 * tau_s) * step_s);
    const double d = c * c + std::numbers::sqrt2 * c + 1;
    const double b = c * c / d;
    const double a1 = 2 * (c * c - 1) / d, a2 = (1 - std::numbers::sqrt2 * c + c * c) / d;
    const T y = b * (value + 2 * x1_ + x2_) - a1 * y1_ - a2 * y2_;
    x2_ = x1_;
    x1_ = value;
    y2_ = y1_;
    y1_ = y;
    return y1_;
  }
  const T& value() const { return y1_; }

 private:
  T x1_ = T::Zero(), x2_ = T::Zero(), y1_ = T::Zero(), y2_ = T::Zero();
};

/// One sample of a device in the fist, in its own frame S.
struct HandReading {
  Eigen::Vector3d specific_force_S_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_S_radps = Eigen::Vector3d::Zero();
  bool clipped = false;  ///< The accelerometer was at the end of its range.
};

/// Options of the filter; the defaults are VQF's (Laidig & Seel 2023, table 2).
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
  /// Gain error of each axis: by which part its reading is too large.
  Eigen::Vector3d gain_errors() const { return errors_.tail<3>(); }

  /// Standard deviations of the attitude: of the heading it grows from the start; of the
  /// inclination it grows while the correction is frozen.
  double heading_sd_rad() const;
  double inclination_sd_rad() const;

 private:
  static constexpr double kRestS = 1.5;
  using Errors = Eigen::Matrix<double, 6, 1>;  ///< Gyroscope's errors: bias, rad/s; gains.
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
  Eigen::Vector3d start_bias_S_ = Eigen::Vector3d::Zero();  ///< Bias at start; taken off at once.
  Errors errors_ = Errors::Zero();  ///< Rest of the bias, at most 2 deg/s each; the gains.
  Eigen::Matrix<double, 6, 6> variance_ = Eigen::Matrix<double, 6, 6>::Zero();  ///< For errors_.
  LowPass<Eigen::Vector3d> force_G_;
  // The turn that errors_ make in W, as the mean force has seen it, and its derivative by them.
  LowPass<Eigen::Vector3d> turned_error_;
  LowPass<Jacobian> turned_;
  LowPass<Eigen::Vector3d> rest_force_S_, rest_turn_S_;
  double rest_s_ = 0, held_s_ = 0;
  double heading_drift_rad_ = 0, heading_noise_rad2_ = 0, heading_turned_rad_ = 0;
  double frozen_drift_rad_ = 0;
};

// Arms from devices with an accelerometer and a gyroscope, in the fists (Ha, Bai & Liu 2011,
// section 5.2) or strapped on upper arms and forearms; docs/hands.md says where this departs from
// the paper.

/// How a device has turned since the T-pose, and what it feels.
struct HandState {
  bool valid = false;
  Eigen::Matrix3d turn_W = Eigen::Matrix3d::Identity();  ///< R_WS(now) R_WS(T-pose)^T.
  Eigen::Vector3d acceleration_W_mps2 = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_W_radps = Eigen::Vector3d::Zero();
  /// Standard deviations of the turn about the vertical, which grows, and about a level axis.
  double heading_sd_rad = 0, inclination_sd_rad = 0;
};

/// The attitude of a device on an arm (AttitudeFilter), from a T-pose on, in which its heading is
/// known. How else it is mounted does not matter. A value.
class HandAttitude {
 public:
  HandAttitude() = default;
  /// `heading_rad`: of S's x in the T-pose; 0 is forwards, pi/2 to the left.
  explicit HandAttitude(double heading_rad);

  /// Non-finite readings are left out.
  void Advance(const HandReading& reading, double step_s);
  /// A T-pose begins: the readings so far do not count. Nothing once aligned.
  void BeginTPose();
  /// The T-pose is held and was for some seconds: the mean turn is the gyroscope's bias, the mean
  /// force is up, and S's x has its heading. Without a second of readings, or with S's x upright
  /// where that matters, the state stays invalid.
  void Align(bool heading_matters = true);
  /// Invalid until aligned.
  const HandState& state() const { return state_; }

 private:
  double rested_s_ = 0;
  Eigen::Vector3d mean_force_S_ = Eigen::Vector3d::Zero(), bias_S_ = Eigen::Vector3d::Zero();
  AttitudeFilter filter_;
  Eigen::Matrix3d R_WF_ = Eigen::Matrix3d::Identity();  ///< F: the filter's world.
  Eigen::Matrix3d R_ST_ = Eigen::Matrix3d::Identity();  ///< R_WS^T of the T-pose.
  HandState state_;
};

/// How a segment turns in a squat, seen from above.
struct SquatTurn {
  /// 1: its upper end goes ahead (pelvis, trunk, shank); -1: back (thigh); 0: no squat is needed,
  /// since what a hand holds points ahead in the T-pose.
  double about_left = 1;
  /// How far to the left of straight ahead it goes in the mean of people; the thigh's lower end.
  double to_left_rad = 0;
  double sd_rad = 0.12;  ///< And how far people are from that.
};

/// Whether a person squats or bows: both feet carry weight and the centre of mass has sunk from
/// where the T-pose has it. Who leans to a side, raises a leg or nods does not.
bool IsSquat(double com_height_m, double t_pose_height_m, double left_load_n, double right_load_n);

/// The attitude of a device that is worn on a segment at any angle, from a T-pose on. The T-pose
/// does not show which way the device points; the way in which it bends in the first squats does.
/// Until then the state is invalid. A shallow bend shows it less surely than a deep one, and the
/// stated deviation says so. A value.
class SegmentAttitude {
 public:
  explicit SegmentAttitude(const SquatTurn& turn = {}) : turn_(turn) {}

  /// `squats`: IsSquat of the person, now.
  void Advance(const HandReading& reading, double step_s, bool squats);
  void BeginTPose() { attitude_.BeginTPose(); }
  void Align();
  const HandState& state() const { return state_; }
  /// Heading in the T-pose of the device's x, or of its y where x is upright: its deviation is that
  /// of the heading without what has drifted since. Where a squat has shown it.
  double heading_rad() const;
  double mounting_sd_rad() const;

 private:
  void Watch(const Eigen::Vector3d& up_F, double step_s);

  SquatTurn turn_;
  HandAttitude attitude_{0};
  Eigen::Vector2d bent_F_ = Eigen::Vector2d::Zero();  ///< Sum of the axes of bends, rad s.
  double bent_rad_s_ = 0, bent_rad2_s_ = 0;           ///< Sums of their angles, and squares.
  HandState state_;
};

/// The rotation about a vector's direction by its length, rad.
inline Eigen::Matrix3d Turned(const Eigen::Vector3d& angle_rad) {
  const double norm_rad = angle_rad.norm();
  if (norm_rad < 1e-12) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(norm_rad, angle_rad / norm_rad).toRotationMatrix();
}

}  // namespace footing::arms
