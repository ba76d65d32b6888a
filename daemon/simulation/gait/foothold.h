#pragma once

#include <optional>

#include "daemon/simulation/gait/context.h"

/// Where to put the next foot: equations (1) and (2) of the gait paper.
///
/// | paper           | here                                      | unit, frame           |
/// |-----------------|-------------------------------------------|-----------------------|
/// | v               | v_WC seen from the heading frame          | m/s, H                |
/// | v_d             | GaitMemory::speed, desired_mps            | m/s, along H's x      |
/// | phi_W_d, phi_R_d| horizontal offset of the foothold         | m, H                  |
/// | phi_o, k_W      | equation (1), from step time and width    | m, s                  |
/// | T               | GaitMemory::hop, support_time_s           | s                     |
/// | k_R             | HoppingGains::velocity_gain_s             | s                     |
///
/// The paper writes angles of the leg; an offset divided by the leg's length is that angle.
namespace footing::gait {

struct WalkingFoothold {
  Eigen::Vector3d p_WF_m = Eigen::Vector3d::Zero();
  double hurry = 0;                   ///< [0, 1): fraction by which the swing clock should gain.
  std::optional<int> strides_to_pit;  ///< As in WalkingStep.
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

}  // namespace footing::gait
