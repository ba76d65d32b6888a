#pragma once

#include <vector>

#include "common/body/landmarks.h"
#include "common/stream/character.h"

namespace footing::scene {

/// Which of a skeleton's links is what of a person.
struct Anatomy {
  bool person = false;  ///< All that a figure is drawn from is there.
  body::Landmarks landmarks{};
  std::vector<int> parents;
  std::vector<float> radii_m;  ///< Half of each link's suggested size; 0 where it has none.
};

/// By the links' names; `person` is false where they are not a person's.
Anatomy FindAnatomy(const stream::Skeleton& skeleton);

/// True when a body of those parents has the same tree, so that the names fit it, too.
bool Fits(const Anatomy& anatomy, const std::vector<int>& parents);

}  // namespace footing::scene
