#include "daemon/simulation/gait/attitude.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/gait/frames.h"

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
  const double bank_rad = running ? BankAngle(memory, gains) : 0;
  const Eigen::Matrix3d desired_R_WB =
      (Eigen::AngleAxisd(memory.heading_rad, Eigen::Vector3d::UnitZ()) *
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

}  // namespace footing::gait
