#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/world.h"
#include "daemon/simulation/gait/gain_table.h"
#include "daemon/simulation/gait/gains.h"

namespace footing::gait {

/// Length servo of one telescoping leg:
/// force = share * clamp(feed forward + kp (length - actual) + kd (rate - actual rate)).
struct AxialTarget {
  double length_m = 0;
  bool follow_rate = false;  ///< Rate from the change of length_m since the last step; else 0.
  double stiffness_n_per_m = 0;
  double damping_ns_per_m = 0;
  double feed_forward_n = 0;
  double min_n = -std::numeric_limits<double>::infinity();
  double share = 1;
};

/// Tasks of a leg's hips and length.
enum class LegTask {
  kPlace,      ///< Hips and length bring the foot to r_HF_W.
  kPlaceHips,  ///< Hips aim the foot along r_HF_W, the length follows `axial`.
  kSupport,    ///< Hips carry the body's attitude, the length follows `axial`.
  kFree,       ///< Hips are damped only, the length follows `axial`.
};

/// Target of one leg.
struct LegTarget {
  LegTask task = LegTask::kFree;
  Eigen::Vector3d r_HF_W_m = Eigen::Vector3d::Zero();  ///< From the hip to where the foot is to be.
  AxialTarget axial;
  double hip_damping_nms_per_rad = 0;  ///< kFree.
};

/// Targets of the joints in a state of a machine, before the servos.
struct Targets {
  std::array<LegTarget, 2> legs;
  bool hopping = false;  ///< Yaw servo of running and jumping.
  bool jumping = false;  ///< Both legs as one virtual leg; lean by speed.
  double flight_s = 0;   ///< That follows: a tilt is to be gone by its end, not sooner.
  double lean_rad = 0;   ///< Desired pitch besides.
  double roll_rad = 0;   ///< Desired roll of a walk, to the left negative, ...
  double yaw_rad = 0;    ///< ... and its yaw off the heading.
  Eigen::Vector3d rate_W_radps = Eigen::Vector3d::Zero();  ///< Desired of the body.
};

/// State of the servos from the last step, for the rates of their targets.
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
  double swing_time_s = 0;                               ///< Time of this step; 0: the gait's own.
  std::optional<int> strides_to_pit;  ///< With this one; 0 steps over it; none is planned for.
  double extends_since_s = 0;         ///< The paper's gaits: when this phase's extension began.
  double support_height_m = 0;        ///< Ground's height that the hip goes by, foot ball's centre.
};

/// The supports of running and jumping: their duration, and the thrust that ends them.
struct HopSupport {
  double support_time_s = 0.2;  ///< T of equation (2), low-passed.
  double touchdown_time_s = 0;
  double energy_loss_j = 15;           ///< A hop loses this; learned from the lift-off speed.
  std::array<double, 2> leg_loss_j{};  ///< Running, a step on this leg loses so much besides.
  double thrust_length_m = 0.95;
  Eigen::Vector3d idle_r_HF_B_m = Eigen::Vector3d::Zero();  ///< The paper's: kept from touchdown.
  std::array<bool, 2> pushed{};        ///< A jump's legs that touched in this Extension, ...
  std::array<int, 2> leg_off_steps{};  ///< ... simulation steps since they did, ...
  bool leg_left = false;               ///< ... and whether one left while the other pushes.
  int off_steps = 0;                   ///< Consecutive simulation steps that looked like lift-off.
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
  double rise_m = 0;                                   ///< Rise of the ground behind it.
};

/// The last hop and the support in progress, for the next hop's prediction. Lengths along the
/// heading.
struct HopMeasures {
  double flight_mps = 0;
  double foot_ahead_m = 0;  ///< Foot ahead of the COM at touchdown.
  double com_ahead_m = 0;   ///< COM ahead of the foot at lift-off.
  double touchdown_height_m = 0.80;
  double foothold_z_m = 0;
  double drop_m = 0.01;      ///< COM's height over its foot at lift-off above that at touchdown.
  double extension_m = 0;    ///< Extension of the spring in this support; 0 when not known.
  double loss_share = 0.25;  ///< Lost part of the spring's energy.
  double extension_time_s = 0.09;
  double bottom_height_m = 0;    ///< COM over the foot where the extension began, ...
  double bottom_mps = 0;         ///< ... and its vertical speed there.
  double rise_offset_m = -0.04;  ///< COM's rise until lift-off, less a share of the extension.
};

/// The pit ahead and the plan of the hops up to it (controller.h).
struct PitMemory {
  PitSighting sighting;
  HopMeasures last_hop;

  bool planned = false;        ///< The pit is near enough to plan for.
  bool last_foothold = false;  ///< The coming foothold is the last one before it.
  bool leaping = false;        ///< This hop crosses it.
  double lift_off_mps = 0;  ///< Vertical, of this support when the pit wants another than the gait.
  double shift_m = 0;       ///< Shift of the foothold in flight along the heading.
};

/// A step of the ground that feet in flight keep clear of.
struct EdgeMemory {
  bool there = false;
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();  ///< Where the character's path crosses it.
  double height_m = 0;                              ///< Height of the higher side.
};

/// State of running's and jumping's plan by the ground that they see (transition.h).
struct GroundMemory {
  double climb_mps = 0;      ///< Added to this lift-off, beyond the gait's own.
  double slope = 0;          ///< Rise over run along the heading, under this support's foot.
  double shift_m = 0;        ///< Shift of the foothold in flight, off an edge, along the heading.
  double towards = 0;        ///< Side of the edge that this flight has decided for: shift_m's sign.
  EdgeMemory behind, ahead;  ///< Edges about the foothold.
};

/// The style's part in the present gains (style.h).
struct StyleMemory {
  bool there = false;                              ///< The gait has a style.
  double share = 0;                                ///< [0, 1].
  double excess_m = 0;                             ///< Walking: as in WalkingFoothold.
  stream::Gait gait = stream::Gait::kUnspecified;  ///< That `share` is for.
};

/// Forces that a median is taken of.
inline constexpr std::size_t kTowForces = 25;

/// The level force that acts on the body besides gravity and contact (rough.h).
struct TowMemory {
  std::array<Eigen::Vector2d, kTowForces> forces_W_n = Zeros();
  std::size_t next = 0;  ///< The oldest one.
  int steps = 0;         ///< Steps of the mean that is being made.
  Eigen::Vector2d momentum_W_ns = Eigen::Vector2d::Zero();  ///< When it began, ...
  Eigen::Vector2d contact_W_ns = Eigen::Vector2d::Zero();   ///< ... and the ground's impulse since.
  Eigen::Vector3d offset_W = Eigen::Vector3d::Zero();  ///< The part that counts, over the weight.

  static std::array<Eigen::Vector2d, kTowForces> Zeros() {
    std::array<Eigen::Vector2d, kTowForces> zeros;
    zeros.fill(Eigen::Vector2d::Zero());
    return zeros;
  }
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

  Eigen::Vector3d foothold_W_m = Eigen::Vector3d::Zero();  ///< Foothold of the foot in flight.
  SpeedTracking speed;
  GaitTransition transition;
  WalkingStep walking_step;
  HopSupport hop;
  PitMemory pit;
  GroundMemory ground;
  StyleMemory style;
  TowMemory tow;
  ServoMemory servo;
};

/// The moment (world frame, N m) that a PD servo on roll, pitch and yaw wants on the body: level,
/// along the heading and turning as it does; jumping leans back with speed, running banks in
/// curves.
Eigen::Vector3d BodyMoment(const biped::BodyState& body, const GaitMemory& memory,
                           const Targets& targets, const AttitudeGains& gains);

/// Roll, rad, at which a run goes through the present curve: to the left negative.
double BankAngle(const GaitMemory& memory, const AttitudeGains& gains);

/// Roll of the body about the heading, rad; to the left negative.
double Roll(const biped::BodyState& body, const GaitMemory& memory);
/// The same beyond the bank: what a push leaves.
double TiltAside(const biped::BodyState& body, const GaitMemory& memory,
                 const AttitudeGains& gains);

/// Heading frame H: the world turned about z so that x points where the character is to go.
inline Eigen::Vector3d ToHeading(double heading_rad, const Eigen::Vector3d& a_W) {
  const double c = std::cos(heading_rad), s = std::sin(heading_rad);
  return {c * a_W.x() + s * a_W.y(), -s * a_W.x() + c * a_W.y(), a_W.z()};
}

/// From the heading frame H to W.
inline Eigen::Vector3d ToWorld(double heading_rad, const Eigen::Vector3d& a_H) {
  return ToHeading(-heading_rad, a_H);
}

/// Hip efforts of the supporting legs, so that all hips and leg forces together put `moment_W_nm`
/// on the body. Fed forward: the moment of the leg forces about the body's COM (hip spacing times
/// three body weights is 40 N m) and the reaction of the other legs' hips, whose efforts must
/// already be in `efforts`. `axial_n` holds the support legs' forces along the leg.
///
/// A foot is a point: torque across the leg is limited by friction, torque along it by torsional
/// friction, both at the load the foot really carries. What both feet could turn more, they do by
/// fore-aft forces against each other.
void CarryBody(const biped::BodyState& body, const biped::BipedParameters& biped,
               const AttitudeGains& gains, const Targets& targets, double heading_rad,
               const Eigen::Vector3d& moment_W_nm, const std::array<double, 2>& axial_n,
               physics::JointEfforts& efforts);

/// Yaw, roll, pitch and joint length of a leg whose foot is r_HF_B from its hip, yaw 0.
std::array<double, 4> LegInverseKinematics(const biped::BipedParameters& biped,
                                           const Eigen::Vector3d& r_HF_B_m);

/// The PD servos: joint efforts that pursue the targets. Placed legs follow their joint targets
/// with the targets' rate fed forward, supporting legs carry the body. `memory.servo` is updated.
physics::JointEfforts Servo(const Targets& targets, const biped::BodyState& body,
                            const biped::BipedParameters& biped, const Gains& gains, double step_s,
                            GaitMemory& memory);

}  // namespace footing::gait
