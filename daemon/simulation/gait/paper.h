#pragma once

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/targets.h"

/// The gaits as Shiratori & Hodgins 2008 print them, for comparison with ours: the machines of
/// Figures 5 and 6 with their changes on contact and movement, equations (1) and (2) as angles of
/// the leg, constant lengths at touchdown and for thrust. No integrator, no plan for ground or
/// pits, no lean, no bank. Servos, measures of a support, turns by steps and the landing between
/// the gaits are shared with ours. PaperGains and PaperHopGains have the numbers; docs/gait.md says
/// what the text of the paper leaves open.
namespace footing::gait {

/// One step of control under PaperGains::laws.
Targets AdvancePaper(const Context& context, GaitMemory& memory);

/// Angle of a leg in walking, rad, equation (1): phi_o + k_W (v_d - v).
double PaperWalkingAngle(double offset_rad, double gain_rad_per_mps, double desired_mps,
                         double actual_mps);

/// Angle of a leg in running and jumping, equation (2): v T / 2 + k_R (v_d - v). The paper's leg is
/// 1 m long, so metres are radians.
double PaperRunningAngle(double support_time_s, double gain_s, double desired_mps,
                         double actual_mps);

}  // namespace footing::gait
