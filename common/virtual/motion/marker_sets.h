#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/virtual/motion/markers.h"

namespace footing::motion {

/// Where the markers of one laboratory's set sit. Names are blank-separated; in those of a side "@"
/// stands for the side's spelling. Of several names the mean is taken, of those after a "|" only if
/// none before is there. An empty field is a marker that the set does not have.
struct MarkerSet {
  std::string_view name;
  std::string_view left, right;  ///< Spellings of "@", blank-separated: either may stand in a file.
  std::string_view asis, psis;   ///< Iliac spines; of a set with one sacral marker, that one.
  std::string_view knee_lateral, knee_medial;
  std::string_view ankle_lateral, ankle_medial;
  std::string_view heel, toe, fifth_metatarsal;
  std::string_view shoulder;
  double shoulder_over_joint_m;  ///< How far those stand over the joint's centre, along the trunk.
  std::string_view elbow_lateral, elbow_medial;
  std::string_view wrist_radius, wrist_ulna, hand;
  std::string_view cervicale, sternum, head;
};

/// All sets known: opencap, plug-in-gait, cmu41, vicon53, imd29.
std::span<const MarkerSet> MarkerSets();

/// The set whose markers the tracks have, by name or, with an empty name, the one of which most are
/// there. Names of markers may have a subject before a ':'. An error lists the sets, or what the
/// one named lacks.
Result<MarkerSet> FindMarkerSet(const MarkerTracks& tracks, std::string_view name = "");

/// Index into tracks of the markers that one field names for a side (0 left, 1 right).
std::vector<int> MarkersOf(const MarkerTracks& tracks, const MarkerSet& set, std::string_view field,
                           int side);

}  // namespace footing::motion
