#include "daemon/simulation/gait/targets.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "common/base/units.h"
#include "daemon/simulation/gait/controller.h"

namespace footing::gait {

double BankAngle(const GaitMemory& memory, const AttitudeGains& gains) {
  return -gains.bank_share * memory.speed.desired_mps * memory.turning_radps / kStandardGravityMps2;
}

double Roll(const biped::BodyState& body, const GaitMemory& memory) {
  const Eigen::Vector3d up_H = ToHeading(memory.heading_rad, body.R_WB.col(2));
  return -std::atan2(up_H.y(), up_H.z());
}

double TiltAside(const biped::BodyState& body, const GaitMemory& memory,
                 const AttitudeGains& gains) {
  return Roll(body, memory) - BankAngle(memory, gains);
}

Eigen::Vector3d BodyMoment(const biped::BodyState& body, const GaitMemory& memory,
                           const Targets& targets, const AttitudeGains& gains) {
  const double lean_rad =
      targets.lean_rad +
      (targets.jumping ? gains.jump_lean_rad_per_mps * memory.speed.desired_mps : 0);
  const bool running = targets.hopping && !targets.jumping;
  const double bank_rad = running ? BankAngle(memory, gains) : targets.roll_rad;
  const Eigen::Matrix3d desired_R_WB =
      (Eigen::AngleAxisd(memory.heading_rad + targets.yaw_rad, Eigen::Vector3d::UnitZ()) *
       Eigen::AngleAxisd(bank_rad, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(lean_rad, Eigen::Vector3d::UnitY()))
          .toRotationMatrix();
  const Eigen::AngleAxisd error_W(desired_R_WB * body.R_WB.transpose());
  const Eigen::Vector3d error_B = body.R_WB.transpose() * (error_W.angle() * error_W.axis());
  const Eigen::Vector3d desired_w_W =
      memory.turning_radps * Eigen::Vector3d::UnitZ() + targets.rate_W_radps;
  const Eigen::Vector3d late_w_B = body.R_WB.transpose() * (desired_w_W - body.w_WB);
  // Servos leave the rate -kp / kd times the tilt at lift-off, which a long flight overshoots.
  const auto before_flight = [&targets](double stiffness, double damping) {
    return targets.flight_s > 0 ? std::min(stiffness, damping / targets.flight_s) : stiffness;
  };
  const Eigen::Array3d stiffness(
      before_flight(gains.roll_stiffness_nm_per_rad, gains.roll_damping_nms_per_rad),
      before_flight(gains.pitch_stiffness_nm_per_rad, gains.pitch_damping_nms_per_rad),
      running           ? gains.run_yaw_stiffness_nm_per_rad
      : targets.jumping ? gains.jump_yaw_stiffness_nm_per_rad
                        : gains.walk_yaw_stiffness_nm_per_rad);
  const Eigen::Array3d damping(gains.roll_damping_nms_per_rad, gains.pitch_damping_nms_per_rad,
                               running           ? gains.run_yaw_damping_nms_per_rad
                               : targets.jumping ? gains.jump_yaw_damping_nms_per_rad
                                                 : gains.walk_yaw_damping_nms_per_rad);
  return body.R_WB * (stiffness * error_B.array() + damping * late_w_B.array()).matrix();
}

namespace {

using Eigen::Vector3d;

/// Loads are believed up to this much beyond the measured ones, so that a foot can take load up.
constexpr double kLoadGrowth = 1.5;
constexpr double kLoadOffsetN = 3.0;
/// Below this total force two supporting legs share evenly.
constexpr double kShareForceN = 1.0;
/// Turning by both feet: half by each, at most this share of friction.
constexpr double kDifferentialShare = 0.5;
constexpr double kDifferentialFriction = 0.3;

bool Supports(const Targets& targets, int leg) {
  return targets.legs[leg].task == LegTask::kSupport;
}

Vector3d HipReaction(const biped::LegState& leg, const double* hip_efforts) {
  const Vector3d efforts(hip_efforts[0], hip_efforts[1], hip_efforts[2]);
  return leg.hinge_axes_W.transpose().inverse() * efforts;
}

/// Torque at one hip within what its foot's contact can hold.
Vector3d WithinFriction(const biped::LegState& leg, const biped::BipedParameters& biped,
                        const AttitudeGains& gains, double load_n, const Vector3d& moment_W) {
  const double along_nm = moment_W.dot(leg.u_HF_W);
  Vector3d across = moment_W - along_nm * leg.u_HF_W;
  const double limit_nm = gains.friction_share * biped.sliding_friction * load_n * leg.length_m;
  if (across.norm() > limit_nm) across *= limit_nm / across.norm();
  const double twist_nm = gains.turning_friction_share * biped.torsional_friction_m * load_n;
  return across + std::clamp(along_nm, -twist_nm, twist_nm) * leg.u_HF_W;
}

}  // namespace

void CarryBody(const biped::BodyState& body, const biped::BipedParameters& biped,
               const AttitudeGains& gains, const Targets& targets, double heading_rad,
               const Vector3d& moment_W_nm, const std::array<double, 2>& axial_n,
               physics::JointEfforts& efforts) {
  const bool both = Supports(targets, 0) && Supports(targets, 1);
  const double total_n = axial_n[0] + axial_n[1];
  Vector3d needed = moment_W_nm;
  for (int i = 0; i < 2; ++i) {
    const biped::LegState& leg = body.legs[i];
    if (!Supports(targets, i)) {
      needed += HipReaction(leg, &efforts[4 * i]);
      continue;
    }
    // Jumping takes the mean force: legs pressed unequally then right the body like a roll spring.
    const double force_n = both && targets.jumping ? total_n / 2 : axial_n[i];
    needed -= (leg.p_WH - body.p_WB).cross(-force_n * leg.u_HF_W);
  }
  const double turning_nm =
      both ? std::clamp(needed.z(), -gains.turning_limit_nm, gains.turning_limit_nm) : 0;
  for (int i = 0; i < 2; ++i) {
    if (!Supports(targets, i)) continue;
    const biped::LegState& leg = body.legs[i];
    const double share = !both ? 1 : total_n > kShareForceN ? axial_n[i] / total_n : 0.5;
    const double load_n = std::max(0.0, std::min(-axial_n[i] * leg.u_HF_W.z(),
                                                 kLoadGrowth * leg.normal_force_n + kLoadOffsetN));
    Vector3d torque = WithinFriction(leg, biped, gains, load_n, -share * needed);
    if (both) {
      const double fore_n =
          -biped::Side(i) * kDifferentialShare * turning_nm / (2 * biped.hip_half_spacing_m);
      const double limit_nm = kDifferentialFriction * biped.sliding_friction * load_n;
      const double pitch_nm = std::clamp(fore_n * leg.length_m, -limit_nm, limit_nm);
      torque += ToWorld(heading_rad, {0, pitch_nm, 0});
    }
    const Vector3d hinges = leg.hinge_axes_W.transpose() * torque;
    std::copy(hinges.data(), hinges.data() + 3, &efforts[4 * i]);
  }
}

namespace {

/// Rates fed forward at most; a target that jumps by more than kTargetJump has none.
constexpr double kJointRateLimit = 8.0;
constexpr double kTargetJump = 0.02;
constexpr double kLengthRateLimitMps = 1.5;

double TargetRate(bool known, double now, double before, double step_s) {
  if (!known || std::fabs(now - before) > kTargetJump) return 0;
  return std::clamp((now - before) / step_s, -kJointRateLimit, kJointRateLimit);
}

double AxialForce(const AxialTarget& target, const biped::LegState& leg, double rate_mps) {
  const double force_n = target.feed_forward_n +
                         target.stiffness_n_per_m * (target.length_m - leg.length_m) +
                         target.damping_ns_per_m * (rate_mps - leg.length_rate_mps);
  return target.share * std::max(force_n, target.min_n);
}

/// Hips, and with `place_length` the length too, by joint PD towards the foot's place.
void PlaceFoot(const LegTarget& target, bool place_length, const biped::BodyState& body, int i,
               const biped::BipedParameters& biped, const ServoGains& gains, double step_s,
               ServoMemory& memory, double* efforts) {
  const biped::LegState& leg = body.legs[i];
  const auto desired = LegInverseKinematics(biped, body.R_WB.transpose() * target.r_HF_W_m);
  const std::array<double, 4> stiffness{
      gains.hip_yaw_stiffness_nm_per_rad, gains.hip_stiffness_nm_per_rad,
      gains.hip_stiffness_nm_per_rad, gains.leg_stiffness_n_per_m};
  const std::array<double, 4> damping{gains.hip_yaw_damping_nms_per_rad,
                                      gains.hip_damping_nms_per_rad, gains.hip_damping_nms_per_rad,
                                      gains.leg_damping_ns_per_m};
  const int joints = place_length ? 4 : 3;
  for (int j = 0; j < joints; ++j) {
    const double rate = TargetRate(memory.placed[i], desired[j], memory.joint_target[i][j], step_s);
    const double limit = j < 3 ? gains.hip_limit_nm : gains.leg_limit_n;
    const double effort = stiffness[j] * (desired[j] - leg.joint_position[j]) +
                          damping[j] * (rate - leg.joint_velocity[j]);
    efforts[j] = std::clamp(effort, -limit, limit);
  }
  if (place_length) efforts[3] -= biped.link_mass_kg * kStandardGravityMps2;
  memory.joint_target[i] = desired;
}

/// Length servo of a leg that is not placed; returns the force along the leg.
double FollowLength(const LegTarget& target, const biped::LegState& leg, int i, double step_s,
                    ServoMemory& memory) {
  const AxialTarget& axial = target.axial;
  double rate_mps = 0;
  if (axial.follow_rate && memory.followed[i]) {
    rate_mps = std::clamp((axial.length_m - memory.length_target_m[i]) / step_s,
                          -kLengthRateLimitMps, kLengthRateLimitMps);
  }
  memory.length_target_m[i] = axial.length_m;
  return AxialForce(axial, leg, rate_mps);
}

}  // namespace

std::array<double, 4> LegInverseKinematics(const biped::BipedParameters& biped,
                                           const Eigen::Vector3d& r_HF_B_m) {
  const double norm_m = std::max(r_HF_B_m.norm(), 1e-6);
  const double length_m = std::clamp(norm_m, biped.leg_length_min_m, biped.leg_length_max_m);
  return {0, std::atan2(r_HF_B_m.y(), -r_HF_B_m.z()),
          -std::asin(std::clamp(r_HF_B_m.x() / norm_m, -0.95, 0.95)),
          length_m - biped.leg_length_m};
}

physics::JointEfforts Servo(const Targets& targets, const biped::BodyState& body,
                            const biped::BipedParameters& biped, const Gains& gains, double step_s,
                            GaitMemory& memory) {
  physics::JointEfforts efforts{};
  std::array<double, 2> support_n{};
  bool supported = false;
  for (int i = 0; i < 2; ++i) {
    const LegTarget& target = targets.legs[i];
    const bool hips = target.task == LegTask::kPlace || target.task == LegTask::kPlaceHips;
    double* leg_efforts = &efforts[4 * i];
    if (hips) {
      PlaceFoot(target, target.task == LegTask::kPlace, body, i, biped, gains.servo, step_s,
                memory.servo, leg_efforts);
    }
    if (target.task == LegTask::kFree) {
      const double damping = target.hip_damping_nms_per_rad;
      const auto& rate = body.legs[i].joint_velocity;
      leg_efforts[0] = -0.05 * damping * rate[0];  // The leg's inertia about itself is tiny.
      leg_efforts[1] = -damping * rate[1];
      leg_efforts[2] = -damping * rate[2];
    }
    if (target.task != LegTask::kPlace) {
      leg_efforts[3] = FollowLength(target, body.legs[i], i, step_s, memory.servo);
    }
    if (target.task == LegTask::kSupport) {
      support_n[i] = leg_efforts[3];
      supported = true;
    }
    memory.servo.placed[i] = hips;
    memory.servo.followed[i] = target.task != LegTask::kPlace && target.axial.follow_rate;
  }
  if (supported) {
    CarryBody(body, biped, gains.attitude, targets, memory.heading_rad,
              BodyMoment(body, memory, targets, gains.attitude), support_n, efforts);
  }
  return efforts;
}

}  // namespace footing::gait
