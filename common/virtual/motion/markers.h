#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

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

inline bool Seen(const Eigen::Vector3d& p) { return p.allFinite(); }

/// InvalidData where fewer than `least` markers are seen for longer than `longest_s`: the pose held
/// there is not a motion.
Result<void> CheckSeen(const MarkerTracks& tracks, std::size_t least, double longest_s);

/// Axes of a file in those of W (x ahead, y left, z up).
enum class FileAxes {
  kZUp,        ///< As W: most C3D files.
  kYUp,        ///< OpenSim: x ahead, y up, z right.
  kYUpZAhead,  ///< Animation: z ahead, y up, x left.
};

/// Which way is up in tracks that do not say: the axis along which the markers of a person, who
/// mostly stands, spread furthest. Between y and z; y is taken for OpenSim's.
FileAxes GuessAxes(const MarkerTracks& tracks);

/// p_W of a place in the file's axes, and of a whole set of tracks.
Eigen::Vector3d ToWorld(FileAxes axes, const Eigen::Vector3d& p);
MarkerTracks ToWorld(FileAxes axes, MarkerTracks tracks);

}  // namespace footing::motion
