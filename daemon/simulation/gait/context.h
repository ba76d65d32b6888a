#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/biped/command.h"
#include "daemon/simulation/gait/gains.h"
#include "daemon/simulation/gait/memory.h"

namespace footing::gait {

/// What one step of control is given. All borrowed for the call.
struct Context {
  const biped::BodyState& body;
  const biped::BipedParameters& biped;
  const Gains& gains;
  const biped::GaitCommand& goal;    ///< The command, or the next gait on the way to it.
  const stream::Track* seen_ground;  ///< Null: walking feels its way.
  double step_s = 0.001;

  double TimeIn(const GaitMemory& memory) const { return body.time_s - memory.phase_start_s; }
};

}  // namespace footing::gait
