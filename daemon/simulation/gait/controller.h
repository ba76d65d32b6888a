#pragma once

#include "common/stream/character.h"
#include "daemon/simulation/gait/context.h"
#include "daemon/simulation/biped/world.h"

/// The four gaits of section 5 as state machines over a floating body: command and body state in,
/// joint efforts out.
namespace footing::gait {

/// Memory of a character that stands on both feet with this heading, stepping in place.
GaitMemory Standing(double heading_rad, double time_s);

/// Leg length at which Standing expects the legs, hips straight, m.
double StandingLength(const biped::BipedParameters& biped, const Gains& gains);

/// One step of control.
physics::JointEfforts Advance(const biped::BodyState& body, const biped::BipedParameters& biped,
                              const Gains& gains, const biped::GaitCommand& command,
                              const stream::Track* seen_ground, double step_s, GaitMemory& memory);

/// The name of the state in the paper's figures.
const char* PhaseName(const GaitMemory& memory);

/// Fills in what the controllers know; falls, distance and who commands are the engine's.
stream::GaitState Describe(const biped::BodyState& body, const biped::GaitCommand& command,
                           const GaitMemory& memory);

}  // namespace footing::gait
