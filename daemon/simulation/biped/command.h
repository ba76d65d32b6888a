#pragma once

#include "common/stream/character.h"

namespace footing::biped {

/// What a person, or a program in a person's place, wants of the character.
struct GaitCommand {
  stream::Gait gait = stream::Gait::kStep;
  double speed_mps = 0;          ///< Along the heading; ignored while stepping in place.
  double height_m = 0.2;         ///< Rise of the COM after lift-off in a jump.
  double turn_per_step_rad = 0;  ///< Change of heading at every touchdown; positive is left.
  double cadence_hz = 0;         ///< Steps a second, of walking and running; 0: the gait's own.

  bool operator==(const GaitCommand&) const = default;
};

}  // namespace footing::biped
