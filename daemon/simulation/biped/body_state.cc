#include "daemon/simulation/biped/body_state.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/base/units.h"

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
  state.contact_force_W_n = observation.contact_force_W_n;
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

namespace {

using stream::Gait;

struct StableRange {
  Gait gait;
  double speed_max_mps;
};

constexpr StableRange kStableRanges[] = {
    {Gait::kStep, 0}, {Gait::kWalk, 1.75}, {Gait::kRun, 6.0}, {Gait::kJump, 2.0}};
static_assert(std::size(kStableRanges) == stream::kGaits.size(), "a range for every gait");
constexpr double kHeightMinM = 0.05;
constexpr double kHeightMaxM = 0.7;

/// Every gait turns by up to kTurnPerStepMaxDeg a step, a run faster than this by less: linearly,
/// down to the fastest run's. So does a leap out of a run, faster than jumps are: by as much as
/// gives the landing the sideways speed of the fastest jump.
constexpr double kRunFullTurnMps = 4;
constexpr double kFastestRunMps = 6, kFastestRunTurnDeg = 5;
constexpr double kFastestJumpMps = 2;

}  // namespace

double TurnLimit(Gait gait, double speed_mps) {
  if (gait == Gait::kUnspecified) return 0;
  if (gait == Gait::kJump && speed_mps > kFastestJumpMps) {
    return DegreesToRadians(kTurnPerStepMaxDeg * kFastestJumpMps / speed_mps);
  }
  if (gait != Gait::kRun) return DegreesToRadians(kTurnPerStepMaxDeg);
  const double share = (speed_mps - kRunFullTurnMps) / (kFastestRunMps - kRunFullTurnMps);
  return DegreesToRadians(
      std::lerp(kTurnPerStepMaxDeg, kFastestRunTurnDeg, std::clamp(share, 0.0, 1.0)));
}

GaitCommand Limited(const GaitCommand& command) {
  const bool finite = std::isfinite(command.speed_mps) && std::isfinite(command.height_m) &&
                      std::isfinite(command.turn_per_step_rad) && std::isfinite(command.cadence_hz);
  if (!finite) return {};
  for (const StableRange& range : kStableRanges) {
    if (range.gait != command.gait) continue;
    GaitCommand limited = command;
    limited.speed_mps = std::clamp(command.speed_mps, 0.0, range.speed_max_mps);
    limited.height_m = std::clamp(command.height_m, kHeightMinM, kHeightMaxM);
    const double turn_max_rad = TurnLimit(command.gait, limited.speed_mps);
    limited.turn_per_step_rad = std::clamp(command.turn_per_step_rad, -turn_max_rad, turn_max_rad);
    limited.cadence_hz = std::max(0.0, command.cadence_hz);
    return limited;
  }
  return {};
}

}  // namespace footing::biped
