#pragma once

#include "daemon/simulation/gait/controller.h"
#include "daemon/simulation/gait/targets.h"

/// The gaits on slippery ground and against a tow: docs/gait.md, "Slippery ground and
/// tows". On ordinary ground, and without a tow, nothing changes.
namespace footing::gait {

/// Whether the ground holds a foot worse than a gait takes for granted (GripGains).
bool IsSlippery(const Context& context);

/// The speed up to which the leg's slant at touchdown is within friction on slippery ground, and
/// within reach against a tow; else infinite. A walk's leg slants by half a step and half the
/// step's width, a hop's by half the way of a support.
double SlantSpeed(const Context& context, const GaitMemory& memory);

/// Part of its rate on other ground by which v_d changes.
double GripPace(const Context& context);

/// Feels what force acts on the body besides gravity and contact, by the rate of its momentum. The
/// median of a quarter of a second counts, of which a push of 0.1 s is the smaller part.
void FeelTow(const Context& context, GaitMemory& memory);

/// A body `height_m` over its foot that is towed balances like one without the tow whose COM is so
/// much further, in W. Zero without a tow.
Eigen::Vector3d TowOffset(const GaitMemory& memory, double height_m);

/// How much lower a walk goes against a tow, to reach further.
double TowCrouch(const Context& context, const GaitMemory& memory);

}  // namespace footing::gait
