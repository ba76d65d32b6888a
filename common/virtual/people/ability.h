#pragma once

#include "common/stream/user_interface.h"

namespace footing::users {

/// What a user has learned of an interface from the demonstration and in five minutes' practice:
/// what it can command, and how long that takes.
struct Ability {
  double walk_min_mps = 0.3, walk_max_mps = 1.3;
  double run_min_mps = 1.6, run_max_mps = 4;
  double jump_mps = 1.5, jump_height_m = 0.35;
  double turn_per_step_rad = 0.0873;
  bool turns_by_degrees = true;  ///< False: none or all of turn_per_step_rad.
  bool jumps_at_once = false;    ///< One gesture is one jump; else it lasts as long as the jump.
  double turn_delay_s = 0.02;    ///< From the user's motion to a changed command.
  /// From the user's motion to the top of the character's first leap, out of a run and out of a
  /// walk: means of the jumps of straight tracks. The user corrects it by what it sees.
  double run_jump_s = 0.8;
  double walk_jump_s = 0.85;
};

/// Of a command given at once, without a body.
Ability DirectAbility();
/// The speeds are those of the demonstration (docs/interfaces.md), the delays what five minutes of
/// practice teach. `turn_by` is of the leg interface.
Ability AbilityWith(stream::UserInterface interface,
                    stream::TurnSource turn_by = stream::TurnSource::kHead);

}  // namespace footing::users
