#pragma once

#include "daemon/simulation/gait/pits.h"

/// Every number of the controllers, with its unit in its name, and its default. What differs from
/// gait to gait, or between slow and fast, is in the tables of daemon/simulation/data/gaits
/// (gain_table.h); a new number here needs a line in gain_fields.cc. How they were found and what
/// they reach: docs/gait.md and docs/tuning.md.
namespace footing::gait {

/// PD servos of the joints, section 5: torque = kp (desired - actual) - kd rate.
struct ServoGains {
  double hip_stiffness_nm_per_rad = 350;
  double hip_damping_nms_per_rad = 22;
  double hip_yaw_stiffness_nm_per_rad = 20;
  double hip_yaw_damping_nms_per_rad = 0.8;
  double leg_stiffness_n_per_m = 4000;
  double leg_damping_ns_per_m = 80;
  double hip_limit_nm = 200;
  double leg_limit_n = 1500;
  double free_hip_damping_nms_per_rad = 2;  ///< Stance leg while its foot is off the ground.
};

/// PD servo of the body's attitude, by the hips of the supporting legs. Overdamped: the rate left
/// at lift-off, not the angle, is what a flight makes worse. Before a flight the rate in roll and
/// pitch is that of body and legs together (running.cc).
struct AttitudeGains {
  double roll_stiffness_nm_per_rad = 250;
  double roll_damping_nms_per_rad = 60;
  double pitch_stiffness_nm_per_rad = 400;
  double pitch_damping_nms_per_rad = 80;
  double run_yaw_stiffness_nm_per_rad = 60;
  double run_yaw_damping_nms_per_rad = 30;
  double jump_yaw_stiffness_nm_per_rad = 40;
  double jump_yaw_damping_nms_per_rad = 45;
  double walk_yaw_stiffness_nm_per_rad = 100;
  double walk_yaw_damping_nms_per_rad = 15;
  double bank_share = 0.8;  ///< Running in a curve, of the angle at which gravity and the turn's
                            ///< acceleration together point along the body.
  double jump_lean_rad_per_mps = -0.14;  ///< Pitch set-point: both legs swinging forward
                                         ///< together pitch the body forward.
  double hop_yaw_momentum_share = 0.5;   ///< Legs' yaw momentum, taken for the body's own.
  double friction_share = 0.7;           ///< Part of the friction cone, for hip torque.
  double turning_friction_share = 0.8;   ///< Torsional friction's part, for torque along the leg.
  double turning_limit_nm = 8;           ///< By fore-aft forces of both feet.
};

/// Gains of walking and stepping.
struct WalkingGains {
  double swing_time_s = 0.32;  ///< Rise and Fall.
  double double_support_time_s = 0.05;
  double hip_height_m = 0.93;  ///< Over the supporting foot.
  double leg_stiffness_n_per_m = 8000;
  double leg_damping_ns_per_m = 250;
  double supported_mass_kg = 11.5;  ///< Feed-forward weight on the supporting leg.
  double leg_length_min_m = 0.62;
  double leg_length_max_m = 1.08;
  double step_width_m = 0.20;
  double feet_cross_m = 0.10;  ///< At most, to catch a push.
  double step_length_limit_m = 0.80;
  double clearance_m = 0.09;
  double speed_integral_s = 0.03;  ///< m of foothold a step for each m/s of error.
  double integral_min_m = -0.12;
  double integral_max_m = 0.15;
  double hurry_rate = 1.0;         ///< Fraction by which the swing clock may gain.
  double hurry_beyond_m = 0.75;    ///< Foothold fore and aft needed beyond this hurries.
  double side_step_limit_m = 1.0;  ///< Between the feet, to catch a push.
  double support_rise_mps = 0.35;  ///< The hip follows a change of ground at this rate.
  double acceleration_mps2 = 1.5;
};

/// Running, and in brackets jumping.
struct HoppingGains {
  double run_leg_stiffness_n_per_m = 3500;
  double run_leg_damping_ns_per_m = 25;
  double jump_leg_stiffness_n_per_m = 2000;  ///< Each leg.
  double jump_leg_damping_ns_per_m = 15;
  double touchdown_length_m = 0.95;
  double run_flight_length_m = 0.82;
  double jump_flight_length_m = 0.62;
  double idle_length_m = 0.72;
  double lengthening_time_s = 0.12;    ///< Jump: from the flight length to the touchdown length.
  double run_lift_off_mps = 1.3;       ///< Vertical.
  double run_velocity_gain_s = 0.09;   ///< -k_R of equation (2).
  double jump_velocity_gain_s = 0.06;  ///< With running's, jumps of 0.5 m in place fall.
  double faster_limit_mps = 1.5;       ///< v - v_d is clamped to [-slower, faster] fore and aft.
  double slower_limit_mps = 1.2;
  double speed_gain_s = -0.012;  ///< Foothold by desired speed: the slow and the fast set in one.
  double run_foot_spacing_m = 0.03;  ///< Half.
  double foothold_limit_m = 0.71;
  double foothold_side_limit_m = 0.4;
  double run_speed_integral_s = 0.015;
  double run_integral_limit_m = 0.08;
  double jump_integral_limit_m = 0.12;
  double first_support_time_s = 0.2;  ///< T of equation (2) before one was measured.
  double acceleration_mps2 = 2.5;
  double braking_mps2 = 4;
};

/// Where a run's idle leg is in a curve.
struct CurveGains {
  double idle_bank = 2.5;   ///< It mirrors the other one about half of this times the bank: with a
                            ///< bank_share of 0.8 about the direction of the whole force.
  double leg_gap_m = 0.07;  ///< Between the legs' axes (KeepLegsApart in foothold.h).
};

/// Steps of the ground that are seen, running and jumping; and slopes, walking.
struct SteppingGains {
  double low_margin_m = 0.06;    ///< Foot's centre from an edge, below it.
  double high_margin_m = 0.04;   ///< Above it.
  double clearance_m = 0.02;     ///< Foot in flight over the edge, ...
  double riser_margin_m = 0.04;  ///< ... and of its centre before it, while it is lower.
  double shortest_leg_m = 0.56;
  double shift_limit_m = 0.12;    ///< Limit for a foothold.
  double shift_limit_mps = 0.25;  ///< Limit for the lift-off speed, for the same end.
  double slowest_mps = 0.8;       ///< Below, flight time moves no foothold.
  double slower_limit_mps = 0.5;  ///< Lift-off slower by at most this, going down.
  double faster_limit_mps = 1.2;  ///< Faster by at most this, going up.
  double steep = 0.23;            ///< Where the ground ahead rises or falls more than this, ...
  double steep_walk_mps = 1.3;    ///< ... no walk is faster.
};

/// Figure 9: how energy is added and taken out between the gaits.
struct TransitionGains {
  double thrust_from_swing = 0.55;  ///< Part of the swing from which Fall may become a thrust.
  double thrust_to_run_mps = 1.17;  ///< Vertical lift-off speed out of walking.
  double thrust_to_jump_mps = 1.0;
  double run_to_walk_mps = 1.4;               ///< Run slows to this, ...
  double run_to_walk_margin_mps = 1.1;        ///< ... and lands into walking up to this above it.
  double leaving_run_mps2 = 8;                ///< Braking of v_d in a run that is to end.
  double leaving_run_gain_s = 0.14;           ///< k_R then, while faster than v_d.
  double leaving_run_lift_off_mps = 0.8;      ///< Lower hops then: sooner down, less to absorb.
  double leaving_run_damping_ns_per_m = 475;  ///< Damping of the leg while it shortens then.
  double landing_reach_m = 0.08;  ///< The last step's foot is put this much further ahead.
  double run_landing_stiffness_n_per_m = 1800;
  double run_landing_damping_ns_per_m = 420;
  double run_to_jump_mps = 4.0;      ///< Up to this the preparatory step may be taken.
  double preparation_gain_s = 0.14;  ///< Sideways k_R of the preparatory step.
  double jump_speed_before_landing_mps = 1.0;
  double jump_to_step_mps = 1.3;  ///< Up to this a jump may land into stepping.
  double jump_landing_stiffness_n_per_m = 900;
  double jump_landing_damping_ns_per_m = 260;
};

/// Crossing pits (pits.h).
struct PitGains {
  PitLimits limits;
  double jump_lift_off_min_mps = 1.1;
  double run_width_max_m = 0.45;  ///< A run crosses this by itself; wider ones want a jump.
  double sight_m = 3;             ///< Nearer pits are planned for even when out of reach.
  double shift_back_m = 0.12;     ///< Shift of a foothold that would come to lie in the pit.
  double shift_ahead_m = 0.25;
  double shift_ahead_s = 0.1;  ///< At most this times the speed: 0.1 s ahead brakes by half of it.
  double jump_speed_max_mps = 3.6;  ///< A faster run crosses as it is, its jump pending.
  double leap_roll_share = 1.5;     ///< Legs' roll momentum, against which the body turns.
  double leap_lean_rad_per_mps = -0.02;
  WalkLimits walk;
  double walk_width_max_m = 0.30;  ///< A walk steps over pits up to this; ...
  double walk_slowest_mps = 0.1;   ///< ... slower it stays before them.
  double walk_over_mps = 1.0;      ///< A faster walk slows down to this to step over one.
  double walk_slow_m = 1.5;        ///< That far before it, where the strides are planned.
  double walk_stop_m = 0.5;        ///< Wider ones: the COM stops this far before, ...
  double walk_stop_mps2 = 0.4;     ///< ... braking by this.
};

/// Gains of recovery from a push, beyond those of the gaits.
struct RecoveryGains {
  double outrun_mps = 2.2;            ///< A walk pushed beyond this goes on by running steps.
  double idle_yield = 1.25;           ///< Roll of running's idle leg for the body's roll, ...
  double idle_yield_limit_rad = 1.4;  ///< ... up to this.
  double spread_mps = 0.5;            ///< At this speed aside a jump's legs are spread in full.
  double jump_yield = 2;              ///< Roll of a jump's far leg for the body's roll beyond ...
  double jump_yield_from_rad = 0.55;  ///< ... this, up to idle_yield_limit_rad.
};

/// How far a command's cadence is followed.
struct CadenceGains {
  double swing_time_min_s = 0.28;  ///< 3.0 steps a second.
  double swing_time_max_s = 0.40;  ///< 2.2, or as slow as the gait's own steps.
  double run_lift_off_min_mps = 1.0;
  double run_lift_off_max_mps = 1.7;
};

/// Anticipation of a command, visible at once.
struct AnticipationGains {
  double lean_rad_per_mps = 0.05;  ///< Per speed still to be gained.
  double lean_limit_rad = 0.08;
  double crouch_m = 0.03;
};

/// Style of walking and stepping: set-points within a step, of the servos that run anyway (docs/
/// gait.md, "Style"). The phase within the step is 0 at touchdown and 1 at the next one. Without
/// style, foresight and the set-points are 0.
struct StyleGains {
  double foresight = 0;             ///< Part of the time to touchdown for which hurry looks ahead.
  double landing_lead = 0.7;        ///< The foot is led ahead by this part of that, ...
  double landing_to_s = 0.42;       ///< ... not in a step this short, ...
  double landing_from_s = 0.56;     ///< ... and in full in one this long, ...
  double landing_smooth_s = 0.005;  ///< ... over a low pass of the hip's pull on the COM.
  double bob_share = 0;             ///< Rise and fall of the hips, as part of a rigid leg's arc.
  double pelvis_roll_rad = 0;       ///< The swing leg's hip goes down by this roll, ...
  double pelvis_roll_lead = 0;      ///< ... this part of a step before the middle of the step.
  double pelvis_yaw_rad = 0;        ///< The landing leg's hip goes ahead by this yaw, at touchdown.
  double nod_rad = 0;               ///< Pitch forward at touchdown, back between.
  double turn_bank_share = 0;       ///< Bank in a walked curve, as bank_share is in a run's.
  double lean_rad_per_mps = 0;      ///< Pitch forward by v_d; in runs too.
};

/// Where the style fades, because balance comes first (style.h).
struct FadeGains {
  double out_s = 0.12;           ///< From all of the style to none of it.
  double in_s = 2;               ///< And back.
  double level_m = 0.03;         ///< None where the ground rises or falls by this ...
  double sight_m = 0.5;          ///< ... within this, behind and ahead, ...
  double sight_s = 1;            ///< ... and as much further ahead as the speed leads in this.
  double turn_from_rad = 0.035;  ///< Turn of a step up to which there is all of it, ...
  double turn_to_rad = 0.07;     ///< ... and from which on there is none.
  double excess_m = 0.02;        ///< Walking: how far outside its box the foothold is, ...
  double speed_error_mps = 0.5;  ///< ... running: error of the speed ahead in flight, ...
  double aside_mps = 0.35;       ///< ... and the speed aside, at which there is none.
  double tilt_rad = 0.15;        ///< None beyond this tilt of the body.
};

/// On ground that holds a foot badly.
struct GripGains {
  double friction = 0.7;  ///< Ground of less sliding friction is slippery: without style, ...
  double walk_share =
      0.75;                ///< ... legs slanting by at most this part of its friction, walking ...
  double run_share = 0.9;  ///< ... and hopping, at touchdown, ...
};

/// Against a force that goes on (rough.h).
struct TowGains {
  double slack_n = 6;        ///< Up to this nothing is done, from twice of it on all.
  double ahead_share = 0.2;  ///< Forwards, of the weight, at most: a foot further ahead stops all.
  double reach_m = 0.45;     ///< v_d is such that no foot is further from the COM at touchdown.
  double crouch_m = 0.4;     ///< The hips of a walk go down by this part of tow over weight, m.
};

/// The gaits as the paper prints them (paper.h). Nothing here acts while `laws` is 0.
struct PaperGains {
  double laws = 0;  ///< 1: the paper's machines and laws in place of ours.
  double touchdown_length_m = 0.93;
  double swing_length_m = 0.84;
  double fall_extension_m = 0.005;
  double rear_extension_m = 0.02;
  double extension_mps = 0.3;
  double reach_mps = 0.3;                     ///< Growth of the swing leg in Fall, until contact.
  double walk_offset_rad = 0;                 ///< phi_o of equation (1), in pitch, ...
  double walk_offset_side_rad = -0.04;        ///< ... and in roll, outwards.
  double walk_gain_rad_per_mps = -0.38;       ///< k_W in pitch, ...
  double walk_side_gain_rad_per_mps = -0.44;  ///< ... and in roll.
  double pick_up_s = 0.05;                    ///< Double Support lasts no longer.
  double rise_passed_m = 0.2;       ///< Walking: Rise ends when the foot is so far ahead, ...
  double rise_height_m = 0.03;      ///< ... stepping: when it is so high; ...
  double rise_sideways_mps = 0.02;  ///< ... or, stepping and: the hip goes its way so fast.
  double step_below_mps = 0.4;      ///< A walk that is to stop steps below this speed.
  double thrust_extension_m = 0.1;  ///< Growth of the support leg in a Fall that becomes a flight.
};

/// The same for running and jumping.
struct PaperHopGains {
  double run_side_gain_s = 0.09;       ///< -k_R of equation (2) in roll.
  double run_extension_m = 0.045;      ///< Beyond the touchdown length, in Extension.
  double jump_extension_share = 0.06;  ///< The same for each root of a metre of height.
  double leap_extension_m = 0.06;      ///< The same in the step of a run that becomes a jump.
  double leaving_extension_m = 0.02;   ///< The same in a run that is to end.
  double landing_extension_m = 0.02;   ///< Beyond it in the Compression that ends a run.
  double landing_shortening_m = 0.06;  ///< Short of it in the one that ends a jump.
};

/// All gains of one gait at one speed.
struct Gains {
  ServoGains servo;
  AttitudeGains attitude;
  WalkingGains walking;
  HoppingGains hopping;
  CurveGains curve;
  SteppingGains stepping;
  TransitionGains transition;
  PitGains pit;
  RecoveryGains recovery;
  CadenceGains cadence;
  AnticipationGains anticipation;
  StyleGains style;
  FadeGains fade;
  GripGains grip;
  TowGains tow;
  PaperGains paper;
  PaperHopGains paper_hop;
};

}  // namespace footing::gait
