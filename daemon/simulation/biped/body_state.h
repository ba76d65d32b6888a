#pragma once

#include <array>

#include "common/stream/character.h"
#include "daemon/simulation/biped/model.h"
#include "daemon/simulation/biped/world.h"

namespace footing::biped {

inline constexpr int kLeft = 0;
inline constexpr int kRight = 1;

/// +1 for the left leg, -1 for the right one: the sign of its side along y.
constexpr double Side(int leg) { return leg == kLeft ? 1.0 : -1.0; }

/// One leg. Hinge order from the body: yaw about z, roll about x, pitch about y, then the
/// telescope along the leg.
struct LegState {
  std::array<double, 4> joint_position{};  ///< yaw, roll, pitch (rad), length - leg_length_m (m).
  std::array<double, 4> joint_velocity{};
  double length_m = 0;  ///< Hip to foot.
  double length_rate_mps = 0;
  Eigen::Vector3d p_WH = Eigen::Vector3d::Zero();              ///< Hip.
  Eigen::Vector3d p_WF = Eigen::Vector3d::Zero();              ///< Foot ball's centre.
  Eigen::Vector3d u_HF_W = -Eigen::Vector3d::UnitZ();          ///< Unit vector from hip to foot.
  Eigen::Matrix3d hinge_axes_W = Eigen::Matrix3d::Identity();  ///< Columns: yaw, roll, pitch.
  double normal_force_n = 0;
  bool touching = false;  ///< Loaded by more than kTouchForceN.
};

/// Below this a foot counts as off the ground, N: a hundredth of the weight.
inline constexpr double kTouchForceN = 1.0;

/// State that the controllers see. Frames: world W (x forward, y left, z up), body B, whole COM C.
struct BodyState {
  double time_s = 0;
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();
  Eigen::Vector3d contact_force_W_n = Eigen::Vector3d::Zero();  ///< In the last step.
  std::array<LegState, 2> legs;
};

/// The state seen in the world's last observation.
BodyState Read(const BipedParameters& parameters, const physics::Observation& observation,
               double time_s);

/// Command of a person, or of a program in a person's place, to the character.
struct GaitCommand {
  stream::Gait gait = stream::Gait::kStep;
  double speed_mps = 0;          ///< Along the heading; ignored while stepping in place.
  double height_m = 0.2;         ///< Rise of the COM after lift-off in a jump.
  double turn_per_step_rad = 0;  ///< Change of heading at every touchdown; positive is left.
  double cadence_hz = 0;         ///< Steps a second, of walking and running; 0: the gait's own.

  bool operator==(const GaitCommand&) const = default;
};

// The commands under which each gait was found stable (docs/gait.md).

/// The largest turn of a step at any speed: what a mapping may ask for.
inline constexpr double kTurnPerStepMaxDeg = 8;

/// The largest turn of a step, rad, by gait and speed: a faster gait turns less.
double TurnLimit(stream::Gait gait, double speed_mps);

/// The command within the range in which its gait was found stable; one that is not finite, or of
/// no known gait, is stepping in place.
GaitCommand Limited(const GaitCommand& command);

}  // namespace footing::biped
