#include "daemon/simulation/biped/body_state.h"

#include <cmath>

namespace footing::biped {
namespace {

/// Axes of the three hinges in the world: each one turns with those before it.
Eigen::Matrix3d HingeAxes(const Eigen::Matrix3d& R_WB, double yaw_rad, double roll_rad) {
  const Eigen::Matrix3d R_WY = R_WB * Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
  const double c = std::cos(roll_rad), s = std::sin(roll_rad);
  Eigen::Matrix3d axes;
  axes.col(0) = R_WB.col(2);
  axes.col(1) = R_WY.col(0);
  axes.col(2) = c * R_WY.col(1) + s * R_WY.col(2);
  return axes;
}

}  // namespace

BodyState Read(const BipedParameters& parameters, const physics::Observation& observation,
               double time_s) {
  BodyState state;
  state.time_s = time_s;
  state.p_WB = observation.p_WB;
  state.v_WB = observation.v_WB;
  state.w_WB = observation.w_WB;
  state.R_WB = observation.R_WB;
  state.p_WC = observation.p_WC;
  state.v_WC = observation.v_WC;
  for (std::size_t i = 0; i < state.legs.size(); ++i) {
    LegState& leg = state.legs[i];
    for (std::size_t j = 0; j < 4; ++j) {
      leg.joint_position[j] = observation.joint_position[4 * i + j];
      leg.joint_velocity[j] = observation.joint_velocity[4 * i + j];
    }
    leg.length_m = parameters.leg_length_m + leg.joint_position[3];
    leg.length_rate_mps = leg.joint_velocity[3];
    leg.p_WH = observation.p_WH[i];
    leg.p_WF = observation.p_WF[i];
    leg.u_HF_W = (leg.p_WF - leg.p_WH) / leg.length_m;
    leg.hinge_axes_W = HingeAxes(state.R_WB, leg.joint_position[0], leg.joint_position[1]);
    leg.normal_force_n = observation.normal_force_n[i];
    leg.touching = leg.normal_force_n > kTouchForceN;
  }
  return state;
}

}  // namespace footing::biped
