#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "common/body/landmarks.h"
#include "common/virtual/motion/marker_sets.h"
#include "common/virtual/motion/markers.h"

namespace footing::motion {

/// Places of the landmarks in one frame, in W; nothing where the markers were not seen.
using Centres = std::array<std::optional<Eigen::Vector3d>, body::kLandmarkCount>;

/// Joint centres from the markers of one frame (z up): hips by regression from the iliac spines (M.
/// Harrington et al., J. Biomechanics 40 (2007) 595, Table 4); knees, ankles, elbows and wrists
/// midway between the markers of both sides or, with one marker, inwards from it by half the
/// joint's width; shoulders below their markers; the base of the neck between C7 and sternum. kHips
/// is the middle of the hips, kHead the middle of the head's markers; kToe the toe's marker.
Centres JointCentres(const MarkerTracks& tracks, const MarkerSet& set, Eigen::Index frame);

}  // namespace footing::motion
