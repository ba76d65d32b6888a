#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/body.h"
#include "common/virtual/motion/markers.h"
#include "common/virtual/motion/motion.h"

/// From markers to the motion of a skeleton.
namespace footing::motion {

/// Facts about the markers that the file does not state.
struct MarkerFitOptions {
  std::string_view set = {};  ///< Name of the marker set; empty: the one that is there.
  body::Sex sex = body::Sex::kMean;
  /// A trial of the same person and markers in which he stands still, with medial markers if there
  /// are any: gives the lengths and the markers' places. Null: the motion itself does.
  const MarkerTracks* still = nullptr;
};

/// One marker on the skeleton.
struct FittedMarker {
  std::string name;
  int joint = 0;
  Eigen::Vector3d p_J = Eigen::Vector3d::Zero();  ///< m.
  double rms_m = 0;                               ///< From its measured places.
};

/// A motion fitted to markers, and how well it fits.
struct MarkerFit {
  Motion motion;
  std::string set;
  double height_m = 0;  ///< Estimated from the lengths.
  double rms_m = 0;     ///< Over all markers and frames.
  std::vector<FittedMarker> markers;
};

/// Fits a standard person to markers in W (z up): lengths of limbs, hips, shoulders and trunk from
/// the joint centres (markers.h), each marker fixed to the segment on which it keeps still
/// best, then, frame by frame, the pose whose markers come nearest to those seen in the sense of
/// least squares. Frames with fewer than ten markers keep the pose before, for a second at most. An
/// error says what is missing.
Result<MarkerFit> FitMarkers(const MarkerTracks& tracks, const MarkerFitOptions& options = {});

/// The standard person with the lengths that lie between the joint centres of these frames
/// (medians), and his estimated height.
struct FittedSkeleton {
  body::Skeleton skeleton;
  double height_m = 0;
};
Result<FittedSkeleton> FitLengths(const MarkerTracks& tracks, const MarkerSet& set, body::Sex sex);

}  // namespace footing::motion
