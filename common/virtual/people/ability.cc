#include "common/virtual/people/ability.h"

namespace footing::users {

using stream::TurnSource;
using stream::UserInterface;

Ability DirectAbility() { return {}; }

Ability AbilityWith(UserInterface interface, TurnSource turn_by) {
  // A demonstrator shows 0.2 to 1.4 m/s of walking and 1.5 to 4.5 m/s of running; a user keeps off
  // the ends.
  Ability ability{.walk_min_mps = 0.4,
                  .walk_max_mps = 1.2,
                  .run_min_mps = 1.9,
                  .run_max_mps = 3.5,
                  .jump_mps = 1,
                  .turns_by_degrees = false};
  switch (interface) {
    case UserInterface::kUnspecified:
    case UserInterface::kWrist:  // A cycle and a half at 2.5 Hz, and the change of the hands.
      ability.turn_delay_s = 0.35;
      ability.run_jump_s = 1.45;
      ability.walk_jump_s = 1.7;
      break;
    case UserInterface::kArm:
      ability.turn_delay_s = 0.5;
      ability.run_jump_s = 1.7;
      ability.walk_jump_s = 2.05;
      break;
    case UserInterface::kLeg:  // Feet show their heights in a whole cycle of either.
      ability.turn_delay_s = turn_by == TurnSource::kFeet ? 0.7 : 0.35;
      ability.run_jump_s = 1.6;
      ability.walk_jump_s = 1.8;
      break;
    case UserInterface::kJoystick:
      ability.turn_delay_s = 0.1;
      ability.jumps_at_once = true;
      ability.run_jump_s = 0.7;
      ability.walk_jump_s = 0.85;
      break;
    case UserInterface::kBoards:  // Steps end, both feet stand, then the heels rise.
      ability.turn_delay_s = 0.6;
      ability.jumps_at_once = true;
      ability.run_jump_s = 1.3;
      ability.walk_jump_s = 1.25;
      break;
  }
  return ability;
}

}  // namespace footing::users
