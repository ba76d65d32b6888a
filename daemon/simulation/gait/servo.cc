#include "daemon/simulation/gait/servo.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/attitude.h"
#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/support.h"

namespace footing::gait {
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
