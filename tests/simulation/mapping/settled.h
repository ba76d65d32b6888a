#pragma once

#include "daemon/simulation/biped/body_state.h"
#include "daemon/simulation/mapping/inputs.h"

namespace footing::mapping {

/// The command after the same inputs every 10 ms for 1.99 s from `from_s` on, longer than any
/// change of gait is held back.
template <typename Interface>
biped::GaitCommand Settled(Interface& interface, double from_s, const Inputs& inputs) {
  biped::GaitCommand command;
  for (int i = 0; i < 200; ++i) command = interface.Advance(from_s + 0.01 * i, inputs);
  return command;
}

}  // namespace footing::mapping
