#include "daemon/simulation/gait/gain_fields.h"

#include <array>

namespace footing::gait {
namespace {

// The column's name is the field's, and its accessor too, so that they cannot differ.
#define GAIN(section, field, unit, min, max)                         \
  GainField {                                                        \
#section "." #field, unit, min, max,                             \
        [](Gains & gains) -> double& { return gains.section.field; } \
  }

constexpr std::array kFields{
    GAIN(servo, hip_stiffness_nm_per_rad, "N m/rad", 0, 2000),
    GAIN(servo, hip_damping_nms_per_rad, "N m s/rad", 0, 100),
    GAIN(servo, hip_yaw_stiffness_nm_per_rad, "N m/rad", 0, 100),
    GAIN(servo, hip_yaw_damping_nms_per_rad, "N m s/rad", 0, 5),
    GAIN(servo, leg_stiffness_n_per_m, "N/m", 100, 20000),
    GAIN(servo, leg_damping_ns_per_m, "N s/m", 0, 500),
    GAIN(servo, hip_limit_nm, "N m", 0, 1000),
    GAIN(servo, leg_limit_n, "N", 0, 10000),
    GAIN(servo, free_hip_damping_nms_per_rad, "N m s/rad", 0, 10),

    GAIN(attitude, roll_stiffness_nm_per_rad, "N m/rad", 0, 1000),
    GAIN(attitude, roll_damping_nms_per_rad, "N m s/rad", 0, 500),
    GAIN(attitude, pitch_stiffness_nm_per_rad, "N m/rad", 0, 2000),
    GAIN(attitude, pitch_damping_nms_per_rad, "N m s/rad", 0, 500),
    GAIN(attitude, run_yaw_stiffness_nm_per_rad, "N m/rad", 0, 200),
    GAIN(attitude, run_yaw_damping_nms_per_rad, "N m s/rad", 0, 200),
    GAIN(attitude, jump_yaw_stiffness_nm_per_rad, "N m/rad", 0, 200),
    GAIN(attitude, jump_yaw_damping_nms_per_rad, "N m s/rad", 0, 200),
    GAIN(attitude, walk_yaw_stiffness_nm_per_rad, "N m/rad", 0, 500),
    GAIN(attitude, walk_yaw_damping_nms_per_rad, "N m s/rad", 0, 100),
    GAIN(attitude, bank_share, "1", 0, 2),
    GAIN(attitude, jump_lean_rad_per_mps, "rad s/m", -1, 1),
    GAIN(attitude, hop_yaw_momentum_share, "1", 0, 2),
    GAIN(attitude, friction_share, "1", 0, 1),
    GAIN(attitude, turning_friction_share, "1", 0, 1),
    GAIN(attitude, turning_limit_nm, "N m", 0, 50),

    GAIN(walking, swing_time_s, "s", 0.05, 1),
    GAIN(walking, double_support_time_s, "s", 0.01, 0.3),
    GAIN(walking, hip_height_m, "m", 0.6, 1.1),
    GAIN(walking, leg_stiffness_n_per_m, "N/m", 100, 50000),
    GAIN(walking, leg_damping_ns_per_m, "N s/m", 0, 1000),
    GAIN(walking, supported_mass_kg, "kg", 0, 50),
    GAIN(walking, leg_length_min_m, "m", 0.3, 1.5),
    GAIN(walking, leg_length_max_m, "m", 0.3, 1.5),
    GAIN(walking, step_width_m, "m", 0, 1),
    GAIN(walking, feet_cross_m, "m", 0, 0.5),
    GAIN(walking, side_step_limit_m, "m", 0, 2),
    GAIN(walking, step_length_limit_m, "m", 0, 1.5),
    GAIN(walking, clearance_m, "m", 0, 0.5),
    GAIN(walking, speed_integral_s, "s", 0, 0.2),
    GAIN(walking, integral_min_m, "m", -0.5, 0),
    GAIN(walking, integral_max_m, "m", 0, 1),
    GAIN(walking, hurry_rate, "1", 0, 5),
    GAIN(walking, hurry_beyond_m, "m", 0, 2),
    GAIN(walking, support_rise_mps, "m/s", 0, 2),
    GAIN(walking, acceleration_mps2, "m/s2", 0, 10),

    GAIN(hopping, run_leg_stiffness_n_per_m, "N/m", 100, 20000),
    GAIN(hopping, run_leg_damping_ns_per_m, "N s/m", 0, 100),
    GAIN(hopping, jump_leg_stiffness_n_per_m, "N/m", 100, 10000),
    GAIN(hopping, jump_leg_damping_ns_per_m, "N s/m", 0, 100),
    GAIN(hopping, touchdown_length_m, "m", 0.3, 1.5),
    GAIN(hopping, run_flight_length_m, "m", 0.3, 1.5),
    GAIN(hopping, jump_flight_length_m, "m", 0.3, 1.5),
    GAIN(hopping, idle_length_m, "m", 0.3, 1.5),
    GAIN(hopping, lengthening_time_s, "s", 0.01, 1),
    GAIN(hopping, run_lift_off_mps, "m/s", 0, 10),
    GAIN(hopping, run_velocity_gain_s, "s", 0, 0.5),
    GAIN(hopping, jump_velocity_gain_s, "s", 0, 0.5),
    GAIN(hopping, faster_limit_mps, "m/s", 0, 10),
    GAIN(hopping, slower_limit_mps, "m/s", 0, 5),
    GAIN(hopping, speed_gain_s, "s", -0.05, 0.05),
    GAIN(hopping, run_foot_spacing_m, "m", 0, 0.2),
    GAIN(hopping, foothold_limit_m, "m", 0, 5),
    GAIN(hopping, foothold_side_limit_m, "m", 0, 2),
    GAIN(hopping, run_speed_integral_s, "s", 0, 0.1),
    GAIN(hopping, run_integral_limit_m, "m", 0, 0.5),
    GAIN(hopping, jump_integral_limit_m, "m", 0, 0.5),
    GAIN(hopping, first_support_time_s, "s", 0.05, 1),
    GAIN(hopping, acceleration_mps2, "m/s2", 0, 10),
    GAIN(hopping, braking_mps2, "m/s2", 0, 20),

    GAIN(curve, idle_bank, "1", 0, 5),
    GAIN(curve, leg_gap_m, "m", 0, 0.3),

    GAIN(transition, thrust_from_swing, "1", 0, 1),
    GAIN(transition, thrust_to_run_mps, "m/s", 0, 5),
    GAIN(transition, thrust_to_jump_mps, "m/s", 0, 5),
    GAIN(transition, run_to_walk_mps, "m/s", 0, 10),
    GAIN(transition, run_to_walk_margin_mps, "m/s", 0, 2),
    GAIN(transition, leaving_run_mps2, "m/s2", 0, 50),
    GAIN(transition, leaving_run_gain_s, "s", 0, 0.5),
    GAIN(transition, leaving_run_lift_off_mps, "m/s", 0, 5),
    GAIN(transition, leaving_run_damping_ns_per_m, "N s/m", 0, 2000),
    GAIN(transition, landing_reach_m, "m", 0, 0.5),
    GAIN(transition, run_landing_stiffness_n_per_m, "N/m", 100, 10000),
    GAIN(transition, run_landing_damping_ns_per_m, "N s/m", 0, 2000),
    GAIN(transition, run_to_jump_mps, "m/s", 0, 20),
    GAIN(transition, preparation_gain_s, "s", 0, 1),
    GAIN(transition, jump_speed_before_landing_mps, "m/s", 0, 5),
    GAIN(transition, jump_to_step_mps, "m/s", 0, 10),
    GAIN(transition, jump_landing_stiffness_n_per_m, "N/m", 100, 5000),
    GAIN(transition, jump_landing_damping_ns_per_m, "N s/m", 0, 2000),

    GAIN(stepping, low_margin_m, "m", 0, 0.5),
    GAIN(stepping, high_margin_m, "m", 0, 0.5),
    GAIN(stepping, clearance_m, "m", 0, 0.5),
    GAIN(stepping, riser_margin_m, "m", 0, 0.5),
    GAIN(stepping, shortest_leg_m, "m", 0.3, 1.5),
    GAIN(stepping, shift_limit_m, "m", 0, 1),
    GAIN(stepping, shift_limit_mps, "m/s", 0, 2),
    GAIN(stepping, slowest_mps, "m/s", 0, 5),
    GAIN(stepping, slower_limit_mps, "m/s", 0, 2),
    GAIN(stepping, faster_limit_mps, "m/s", 0, 5),

    GAIN(pit, limits.edge_margin_m, "m", 0, 0.5),
    GAIN(pit, limits.landing_margin_m, "m", 0, 0.5),
    GAIN(pit, limits.aim_margin_m, "m", 0, 0.5),
    GAIN(pit, limits.lift_off_min_mps, "m/s", 0, 5),
    GAIN(pit, limits.lift_off_max_mps, "m/s", 0, 5),
    GAIN(pit, limits.leap_max_mps, "m/s", 0, 10),
    GAIN(pit, run_width_max_m, "m", 0, 2),
    GAIN(pit, sight_m, "m", 0, 20),
    GAIN(pit, shift_back_m, "m", 0, 0.5),
    GAIN(pit, shift_ahead_m, "m", 0, 1),
    GAIN(pit, shift_ahead_s, "s", 0, 1),
    GAIN(pit, jump_lift_off_min_mps, "m/s", 0, 5),
    GAIN(pit, jump_speed_max_mps, "m/s", 0, 10),
    GAIN(pit, leap_roll_share, "1", -1, 5),
    GAIN(pit, leap_lean_rad_per_mps, "rad s/m", -1, 1),

    GAIN(pit, walk.near_margin_m, "m", 0, 0.5),
    GAIN(pit, walk.far_margin_m, "m", 0, 0.5),
    GAIN(pit, walk.aim_margin_m, "m", 0, 0.5),
    GAIN(pit, walk.stride_max_m, "m", 0, 1.5),
    GAIN(pit, walk.stride_min_m, "m", -0.5, 0.5),
    GAIN(pit, walk_width_max_m, "m", 0, 1),
    GAIN(pit, walk_slowest_mps, "m/s", 0, 2),
    GAIN(pit, walk_over_mps, "m/s", 0.1, 2),
    GAIN(pit, walk_slow_m, "m", 0, 5),
    GAIN(pit, walk_stop_m, "m", 0, 2),
    GAIN(pit, walk_stop_mps2, "m/s2", 0.01, 10),

    GAIN(recovery, outrun_mps, "m/s", 0, 10),
    GAIN(recovery, idle_yield, "1", 0, 5),
    GAIN(recovery, idle_yield_limit_rad, "rad", 0, 2),
    GAIN(recovery, spread_mps, "m/s", 0.01, 5),
    GAIN(recovery, jump_yield, "1", 0, 5),
    GAIN(recovery, jump_yield_from_rad, "rad", 0, 2),

    GAIN(cadence, swing_time_min_s, "s", 0.1, 1),
    GAIN(cadence, swing_time_max_s, "s", 0.1, 1),
    GAIN(cadence, run_lift_off_min_mps, "m/s", 0, 5),
    GAIN(cadence, run_lift_off_max_mps, "m/s", 0, 5),

    GAIN(anticipation, lean_rad_per_mps, "rad s/m", 0, 1),
    GAIN(anticipation, lean_limit_rad, "rad", 0, 1),
    GAIN(anticipation, crouch_m, "m", 0, 0.3),

    GAIN(style, foresight, "1", 0, 1),
    GAIN(style, landing_lead, "1", 0, 1),
    GAIN(style, landing_to_s, "s", 0.1, 1.5),
    GAIN(style, landing_from_s, "s", 0.1, 1.5),
    GAIN(style, landing_smooth_s, "s", 0, 0.1),
    GAIN(style, bob_share, "1", 0, 1.5),
    GAIN(style, pelvis_roll_rad, "rad", -0.3, 0.3),
    GAIN(style, pelvis_roll_lead, "1", -0.5, 0.5),
    GAIN(style, pelvis_yaw_rad, "rad", -0.3, 0.3),
    GAIN(style, nod_rad, "rad", -0.2, 0.2),
    GAIN(style, turn_bank_share, "1", 0, 2),
    GAIN(style, lean_rad_per_mps, "rad s/m", -0.1, 0.1),

    GAIN(fade, out_s, "s", 0.001, 10),
    GAIN(fade, in_s, "s", 0.001, 60),
    GAIN(fade, level_m, "m", 0, 1),
    GAIN(fade, sight_m, "m", 0, 3),
    GAIN(fade, sight_s, "s", 0, 5),
    GAIN(fade, turn_from_rad, "rad", 0, 1),
    GAIN(fade, turn_to_rad, "rad", 0, 1),
    GAIN(fade, excess_m, "m", 0, 1),
    GAIN(fade, speed_error_mps, "m/s", 0, 10),
    GAIN(fade, aside_mps, "m/s", 0, 10),
    GAIN(fade, tilt_rad, "rad", 0, 1),

    GAIN(grip, friction, "1", 0, 5),
    GAIN(grip, walk_share, "1", 0.1, 1),
    GAIN(grip, run_share, "1", 0.1, 2),

    GAIN(tow, slack_n, "N", 1, 1000),
    GAIN(tow, ahead_share, "1", 0, 1),
    GAIN(tow, reach_m, "m", 0, 1),
    GAIN(tow, crouch_m, "m", 0, 1),

    GAIN(paper, laws, "1", 0, 1),
    GAIN(paper, touchdown_length_m, "m", 0.6, 1.1),
    GAIN(paper, swing_length_m, "m", 0.55, 1.1),
    GAIN(paper, fall_extension_m, "m", -0.1, 0.2),
    GAIN(paper, rear_extension_m, "m", -0.1, 0.2),
    GAIN(paper, extension_mps, "m/s", 0, 5),
    GAIN(paper, walk_offset_rad, "rad", -1, 1),
    GAIN(paper, walk_offset_side_rad, "rad", -1, 1),
    GAIN(paper, walk_gain_rad_per_mps, "rad s/m", -2, 0),
    GAIN(paper, walk_side_gain_rad_per_mps, "rad s/m", -2, 0),
    GAIN(paper, pick_up_s, "s", 0.01, 2),
    GAIN(paper_hop, run_side_gain_s, "s", 0, 1),
    GAIN(paper, thrust_extension_m, "m", 0, 0.5),
    GAIN(paper, reach_mps, "m/s", 0, 5),
    GAIN(paper, step_below_mps, "m/s", 0, 3),
    GAIN(paper, rise_passed_m, "m", -0.5, 0.5),
    GAIN(paper, rise_height_m, "m", 0, 0.3),
    GAIN(paper, rise_sideways_mps, "m/s", -1, 1),
    GAIN(paper_hop, run_extension_m, "m", 0, 0.2),
    GAIN(paper_hop, jump_extension_share, "m^0.5", 0, 1),
    GAIN(paper_hop, leap_extension_m, "m", 0, 0.2),
    GAIN(paper_hop, leaving_extension_m, "m", 0, 0.2),
    GAIN(paper_hop, landing_extension_m, "m", -0.2, 0.2),
    GAIN(paper_hop, landing_shortening_m, "m", -0.2, 0.2),
};

#undef GAIN

}  // namespace

std::span<const GainField> GainFields() { return kFields; }

const GainField* FindGain(std::string_view name) {
  for (const GainField& field : kFields) {
    if (field.name == name) return &field;
  }
  return nullptr;
}

}  // namespace footing::gait
