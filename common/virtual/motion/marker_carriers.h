#pragma once

#include <vector>

#include "common/body/landmarks.h"
#include "common/body/skeleton.h"
#include "common/virtual/motion/marker_sets.h"
#include "common/virtual/motion/markers.h"

namespace footing::motion {

/// Which joints can carry each marker of a trial.
struct MarkerCarriers {
  std::vector<int> candidates;  ///< For a marker of which the set does not say where it sits.
  std::vector<int> known;       ///< Of each track; -1 where the set does not say.

  std::vector<int> Of(std::size_t track) const {
    return known[track] < 0 ? candidates : std::vector<int>{known[track]};
  }
};

MarkerCarriers FindCarriers(const body::Skeleton& skeleton, const body::Landmarks& landmarks,
                            const MarkerTracks& tracks, const MarkerSet& set);

}  // namespace footing::motion
