#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "daemon/simulation/gait/phase.h"

namespace footing::gait {

/// What the servos remember of the last step, for the rates of their targets.
struct ServoMemory {
  std::array<bool, 2> placed{};  ///< The leg's hips were servoed in the last step.
  std::array<std::array<double, 4>, 2> joint_target{};
  std::array<bool, 2> followed{};
  std::array<double, 2> length_target_m{};
};

/// Foothold corrections learned a step at a time, m; only at settled speed.
struct SpeedIntegrators {
  double walk_m = 0;
  double run_m = 0;
  double jump_m = 0;
};

/// v_d and what keeps the speed at it.
struct SpeedTracking {
  double desired_mps = 0;  ///< v_d, slewed towards target_mps.
  double target_mps = 0;
  SpeedIntegrators integrators;
};

/// Changes of gait that are under way (transition.h).
struct GaitTransition {
  bool thrusting = false;          ///< In Fall: the supporting leg extends for a flight phase.
  bool absorbing = false;          ///< In Compression: landing into walking or stepping.
  bool preparing_landing = false;  ///< Running's last step before walking or stepping.
  bool preparing_jump = false;     ///< Running's last step before a jump.
  bool after_jump = false;         ///< Stepping that came from a jump.
};

/// The present step of walking or stepping.
struct WalkingStep {
  Eigen::Vector3d swing_start_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d landed_W_m = Eigen::Vector3d::Zero();  ///< Where the supporting foot touched.
  double swing_time_s = 0;                               ///< Of this step; 0: the gait's own.
  std::optional<int> strides_to_pit;  ///< With this one; 0 steps over it; none is planned for.
  double support_height_m = 0;        ///< Ground's height that the hip goes by, foot ball's centre.
};

/// The supports of running and jumping: their duration, and the thrust that ends them.
struct HopSupport {
  double support_time_s = 0.2;  ///< T of equation (2), low-passed.
  double touchdown_time_s = 0;
  double energy_loss_j = 15;           ///< A hop loses this; learned from the lift-off speed.
  std::array<double, 2> leg_loss_j{};  ///< Running, a step on this leg loses so much besides.
  double thrust_length_m = 0.95;
  int off_steps = 0;  ///< Consecutive simulation steps that looked like lift-off.
};

/// The last touchdown, for the speed over one step.
struct LastStep {
  bool known = false;
  double time_s = 0;
  Eigen::Vector3d p_WC = Eigen::Vector3d::Zero();
  stream::Gait gait = stream::Gait::kUnspecified;
  int steps_in_gait = 0;
};

/// The nearest pit on the path.
struct PitSighting {
  bool ahead = false;
  Eigen::Vector2d near_W_m = Eigen::Vector2d::Zero();  ///< A point of the near edge.
  Eigen::Vector2d along_W = Eigen::Vector2d::UnitX();  ///< Across the edges.
  double length_m = 0;                                 ///< From edge to edge.
  double rise_m = 0;                                   ///< Of the ground behind it.
};

/// The last hop and the support in progress, for the next hop's prediction. Lengths along the
/// heading.
struct HopMeasures {
  double flight_mps = 0;
  double foot_ahead_m = 0;  ///< Of the COM at touchdown.
  double com_ahead_m = 0;   ///< Of the foot at lift-off.
  double touchdown_height_m = 0.80;
  double foothold_z_m = 0;
  double drop_m = 0.01;      ///< COM's height over its foot at lift-off above that at touchdown.
  double extension_m = 0;    ///< Of the spring in this support; 0 when not known.
  double loss_share = 0.25;  ///< Of the spring's energy.
  double extension_time_s = 0.09;
  double bottom_height_m = 0;    ///< COM over the foot where the extension began.
  double rise_offset_m = -0.04;  ///< What it rises until lift-off, less a share of the extension.
};

/// The pit ahead and the plan of the hops up to it (pit_sight.h).
struct PitMemory {
  PitSighting sighting;
  HopMeasures last_hop;

  bool planned = false;        ///< The pit is near enough to plan for.
  bool last_foothold = false;  ///< The coming foothold is the last one before it.
  bool leaping = false;        ///< This hop crosses it.
  double lift_off_mps = 0;  ///< Vertical, of this support when the pit wants another than the gait.
  double shift_m = 0;       ///< By which the foothold in flight is moved along the heading.
};

/// A step of the ground that feet in flight keep clear of.
struct EdgeMemory {
  bool there = false;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Where the character's path crosses it.
  double height_m = 0;                              ///< Of the higher side.
};

/// What running and jumping plan by the ground they see (ground_plan.h).
struct GroundMemory {
  double climb_mps = 0;      ///< Of this lift-off, beyond the gait's own.
  double slope = 0;          ///< Rise over run along the heading, under this support's foot.
  double shift_m = 0;        ///< Of the foothold in flight, off an edge, along the heading.
  double towards = 0;        ///< Side of the edge that this flight has decided for: shift_m's sign.
  EdgeMemory behind, ahead;  ///< Of the foothold.
};

/// All that the controllers remember between steps: a plain value.
struct GaitMemory {
  stream::Gait gait = stream::Gait::kStep;
  WalkingPhase walking = WalkingPhase::kDoubleSupport;
  RunningPhase running = RunningPhase::kUpwardFlight;
  int support_leg = 0;  ///< The one that carries, or in flight the one to land on.
  double phase_start_s = 0;

  double heading_rad = 0;
  double turning_radps = 0;  ///< Mean rate at which the heading turns in this step.
  double step_time_s = 0.4;  ///< From touchdown to touchdown, low-passed.
  std::uint64_t steps = 0;
  LastStep last_step;

  Eigen::Vector3d foothold_W_m = Eigen::Vector3d::Zero();  ///< Of the foot in flight.
  SpeedTracking speed;
  GaitTransition transition;
  WalkingStep walking_step;
  HopSupport hop;
  PitMemory pit;
  GroundMemory ground;
  ServoMemory servo;
};

}  // namespace footing::gait
