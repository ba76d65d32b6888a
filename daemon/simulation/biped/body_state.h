#pragma once

#include <array>

#include "daemon/simulation/biped/parameters.h"
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

/// What the controllers see. Frames: world W (x forward, y left, z up), body B, whole COM C.
struct BodyState {
  double time_s = 0;
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WB = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_WB = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_WC = Eigen::Vector3d::Zero();
  std::array<LegState, 2> legs;
};

/// The state seen in the world's last observation.
BodyState Read(const BipedParameters& parameters, const physics::Observation& observation,
               double time_s);

}  // namespace footing::biped
