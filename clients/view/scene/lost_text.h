#pragma once

#include <optional>
#include <string>

#include "clients/view/scene/update.h"

/// That the person's devices are silent, in words for whoever stands in front of the screen.
namespace footing::scene {

struct LostSignal {
  std::string what;    ///< "No signal from the left hand and the right hand".
  std::string effect;  ///< What the character does meanwhile.
  std::string advice;  ///< What to do.
};

/// None while all devices of the character's interface are there, and while it follows commands in
/// their place.
std::optional<LostSignal> LostSignalOf(const CharacterPose& pose);

/// All of it in one line; empty: nothing is lost.
std::string LostLine(const CharacterPose& pose);

}  // namespace footing::scene
