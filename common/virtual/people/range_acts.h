#pragma once

#include <vector>

#include "common/stream/user_interface.h"
#include "common/virtual/people/sight.h"

namespace footing::users {

/// What a user does for a while.
struct Act {
  Intention wanted;
  double duration_s = 0;
};

/// The motions for which `footing-study ranges` prompts, as a user of this interface performs them:
/// slow and fast, low and high, to the left and to the right. `turn_by` is of the leg interface.
/// Empty for a joystick, on which style has no effect.
std::vector<Act> RangeActs(stream::UserInterface interface,
                           stream::TurnSource turn_by = stream::TurnSource::kHead);
/// What is wanted at this time, s, behind the last act from the first one again. `acts` must not be
/// empty.
const Intention& WantedAt(const std::vector<Act>& acts, double time_s);

}  // namespace footing::users
