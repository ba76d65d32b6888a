#pragma once

#include <optional>

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/targets.h"

/// Where to put the next foot: equations (1) and (2) of the gait paper.
///
/// | paper           | here                                      | unit, frame           |
/// |-----------------|-------------------------------------------|-----------------------|
/// | v               | v_WC seen from the heading frame          | m/s, H                |
/// | v_d             | GaitMemory::speed, desired_mps            | m/s, along H's x      |
/// | phi_W_d, phi_R_d| horizontal offset of the foothold         | m, H                  |
/// | phi_o, k_W      | equation (1), from step time and width    | m, s                  |
/// | T               | GaitMemory::hop, support_time_s           | s                     |
/// | -k_R            | run_, jump_velocity_gain_s (HoppingGains) | s                     |
///
/// The paper writes angles of the leg; an offset divided by the leg's length is that angle.
namespace footing::gait {

/// Planned foothold of the swing leg, W.
struct WalkingFoothold {
  Eigen::Vector3d p_WF_m = Eigen::Vector3d::Zero();
  double hurry = 0;     ///< Fraction by which the swing clock should gain.
  double excess_m = 0;  ///< How far the foothold that balance wants is outside its box.
  std::optional<int> strides_to_pit;  ///< As in WalkingStep.
  bool foreseen = false;              ///< Led to where it will be at touchdown, not where it is.
};

/// Equation (1), phi_W_d = phi_o + k_W (v_d - v), as a foothold relative to the supporting foot.
/// For an inverted pendulum of height h, w = sqrt(g / h) and step time T, a foot put at
/// v / w - v_d T / (e^(w T) - 1) ahead of the COM makes the next step end with v_d: so k_W is -1 /
/// w and phi_o follows from v_d and T. Sideways the same with the step width in v_d's place.
WalkingFoothold PlanWalkingFoothold(const Context& context, const GaitMemory& memory);

/// Equation (2), phi_R_d = v T / 2 + k_R (v_d - v) with k_R < 0 for an offset ahead of the COM:
/// world, horizontal, relative to the COM. Both legs of a jump land beside each other.
Eigen::Vector3d HoppingFoothold(const Context& context, const GaitMemory& memory, int leg);

/// From a leg's hip to a foot `length_m` away whose horizontal offset from the COM is given.
Eigen::Vector3d HipToFoot(const biped::BodyState& body, int leg,
                          const Eigen::Vector3d& offset_from_com_W_m, double length_m);

/// The idle leg's mirror image of the other leg, in pitch and roll, so that the two legs' swings
/// cancel: vector from hip to foot of `length_m`, given the other's. Besides it rolls by
/// `aside_rad`, foot to the left positive.
Eigen::Vector3d Mirrored(double heading_rad, const Eigen::Vector3d& other_r_HF_W_m, double length_m,
                         double aside_rad);

/// At every touchdown: turns the heading by the commanded increment, counts the step, and corrects
/// the gait's foothold by the speed error over the step just made, once the command has settled.
/// (Integrating while the speed is still changing winds up and ends in vaulting.)
void CountStep(const Context& context, GaitMemory& memory);

/// Keeps a run's idle leg out of the other one: where they would be less than
/// CurveGains::leg_gap_m apart sideways, and no further fore and aft, its target turns outwards,
/// in a curve from a little before they pass each other.
/// After a push to the side the idle leg's swing takes up what would turn the body over, and goes
/// first.
void KeepLegsApart(const Context& context, const GaitMemory& memory, Targets& targets);

/// How far outside of the supporting foot a walk's swing foot is put that would balance the body
/// `outward_m` outside: at least the gap, until balance asks for a foothold beyond the other foot's
/// line. From there on it crosses, and from a gap beyond it on it lands where balance asks. What a
/// foothold is kept outside, the next one makes good.
double SideStep(double outward_m, double gap_m);

/// Pitch of the body, rad, forward positive, for the speed that v_d has still to gain. This and the
/// crouch anticipate a command before physics can follow it ("a visible anticipation at once"):
/// they are set-points of servos that run anyway, small enough not to disturb the balance.
double AnticipatedLean(const Context& context, const GaitMemory& memory);

/// How much lower the hips of a walk go, m, that waits for its Fall to jump.
double AnticipatedCrouch(const Context& context, const GaitMemory& memory);

// Steps at the user's own rate, as far as a gait stays robust: subjects of the paper missed "a
// tight coupling between running speed and stepping speed". A command without cadence leaves each
// gait its own.

/// Rise and Fall of the present step, s. Equation (1) follows it, so the speed stays.
double SwingTime(const Context& context, const GaitMemory& memory);
/// The same and Double Support: from touchdown to touchdown.
double StepTime(const Context& context, const GaitMemory& memory);
/// Part of a walking step that is over: 0 at touchdown, 1 at the next one.
double StepPhase(const Context& context, const GaitMemory& memory);
/// Rise and Fall of the step that begins, by the command, s.
double CommandedSwingTime(const Context& context);
/// Vertical speed of a run's lift-off, m/s: flight takes the step's time less the support's.
double RunLiftOffSpeed(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
