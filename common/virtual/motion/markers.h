#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/body/landmarks.h"
#include "common/body/skeleton.h"

namespace footing::motion {

/// Marker places through time, at equal steps, in the axes of the file they come from.
struct MarkerTracks {
  double rate_hz = 0;
  double start_s = 0;  ///< Time of the first frame, on the clock that forces beside them share.
  std::vector<std::string> names;
  /// One a marker: 3 x frames, m. A marker not seen in a frame has a column of NaN: ask Seen().
  std::vector<Eigen::Matrix3Xd> p;

  Eigen::Index frames() const { return p.empty() ? 0 : p.front().cols(); }
};

/// Index of the marker of that name, or -1. Case matters.
int FindMarker(const MarkerTracks& tracks, std::string_view name);

/// Whether a marker was seen: its place is finite.
inline bool Seen(const Eigen::Vector3d& p) { return p.allFinite(); }

/// InvalidData where fewer than `least` markers are seen for longer than `longest_s`: the pose held
/// there is not a motion.
Result<void> CheckSeen(const MarkerTracks& tracks, std::size_t least, double longest_s);

/// InvalidData where `what` moves by `step_m` from the frame before to `frame` as nothing of a
/// person does: faster than 100 m/s (a recording may lose its person for a moment), or, at a low
/// rate, by more than 2 m faster than 15 m/s.
Result<void> CheckStep(double step_m, double rate_hz, double start_s, Eigen::Index frame,
                       const std::string& what);

/// Axes of a file in those of W (x ahead, y left, z up).
enum class FileAxes {
  kZUp,        ///< As W: most C3D files.
  kYUp,        ///< OpenSim: x ahead, y up, z right.
  kYUpZAhead,  ///< Animation: z ahead, y up, x left.
};

/// Which way is up in tracks that do not say, y (taken for OpenSim's) or z: the axis along which
/// the shoulders of a person, who mostly stands, are over the heels. Without a known marker set,
/// the axis along which the markers spread further, which the arms of a T-pose can mislead.
FileAxes GuessAxes(const MarkerTracks& tracks);

/// p_W of a place in the file's axes, and of a whole set of tracks.
Eigen::Vector3d ToWorld(FileAxes axes, const Eigen::Vector3d& p);
MarkerTracks ToWorld(FileAxes axes, MarkerTracks tracks);

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

/// The set whose markers the tracks have, by name or, with an empty name, the one of which most are
/// there. Names of markers may have a subject before a ':'. An error lists the sets, or what the
/// one named lacks.
Result<MarkerSet> FindMarkerSet(const MarkerTracks& tracks, std::string_view name = "");

/// Index into tracks of the markers that one field names for a side (0 left, 1 right).
std::vector<int> MarkersOf(const MarkerTracks& tracks, const MarkerSet& set, std::string_view field,
                           int side);

/// Which joints can carry each marker of a trial.
struct MarkerCarriers {
  std::vector<int> candidates;  ///< For a marker of which the set does not say where it sits.
  std::vector<int> known;       ///< Joint of each track; -1 where the set does not say.

  std::vector<int> Of(std::size_t track) const {
    return known[track] < 0 ? candidates : std::vector<int>{known[track]};
  }
};

/// Joints that can carry each marker, by the set and the landmarks.
MarkerCarriers FindCarriers(const body::Skeleton& skeleton, const body::Landmarks& landmarks,
                            const MarkerTracks& tracks, const MarkerSet& set);

/// Places of the landmarks in one frame, in W; nothing where the markers were not seen.
using Centres = std::array<std::optional<Eigen::Vector3d>, body::kLandmarkCount>;

/// Joint centres from the markers of one frame (z up): hips by regression from the iliac spines (M.
/// Harrington et al., J. Biomechanics 40 (2007) 595, Table 4); knees, ankles, elbows and wrists
/// midway between the markers of both sides or, with one marker, inwards from it by half the
/// joint's width; shoulders below their markers; the base of the neck between C7 and sternum. kHips
/// is the middle of the hips, kHead the middle of the head's markers; kToe the toe's marker.
Centres JointCentres(const MarkerTracks& tracks, const MarkerSet& set, Eigen::Index frame);

}  // namespace footing::motion
