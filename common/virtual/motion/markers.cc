#include "common/virtual/motion/markers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/body/y_up.h"
#include "common/base/number.h"

namespace footing::motion {

int FindMarker(const MarkerTracks& tracks, std::string_view name) {
  for (std::size_t i = 0; i < tracks.names.size(); ++i) {
    if (tracks.names[i] == name) return static_cast<int>(i);
  }
  return -1;
}

Result<void> CheckSeen(const MarkerTracks& tracks, std::size_t least, double longest_s) {
  Eigen::Index last = -1;  // Frame with enough of them.
  for (Eigen::Index frame = 0; frame < tracks.frames(); ++frame) {
    const auto seen = std::count_if(tracks.p.begin(), tracks.p.end(),
                                    [&](const auto& track) { return Seen(track.col(frame)); });
    if (static_cast<std::size_t>(seen) >= least) last = frame;
    if (static_cast<double>(frame - last) <= longest_s * tracks.rate_hz) continue;
    const double from_s = tracks.start_s + static_cast<double>(last + 1) / tracks.rate_hz;
    return InvalidData("fewer than " + std::to_string(least) + " markers are seen for more than " +
                       text::Fixed(longest_s, 1) + " s from " + text::Fixed(from_s, 2) +
                       " s on; cut the trial there");
  }
  return {};
}

FileAxes GuessAxes(const MarkerTracks& tracks) {
  constexpr Eigen::Index kSamples = 50;
  const Eigen::Index step = std::max<Eigen::Index>(1, tracks.frames() / kSamples);
  Eigen::Vector3d spread = Eigen::Vector3d::Zero();
  for (Eigen::Index frame = 0; frame < tracks.frames(); frame += step) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Matrix3Xd& track : tracks.p) {
      const Eigen::Vector3d p = track.col(frame);
      if (Seen(p)) box.extend(p);
    }
    if (!box.isEmpty()) spread += box.sizes();
  }
  return spread.y() > spread.z() ? FileAxes::kYUp : FileAxes::kZUp;
}

Eigen::Vector3d ToWorld(FileAxes axes, const Eigen::Vector3d& p) {
  switch (axes) {
    case FileAxes::kZUp:
      return p;
    case FileAxes::kYUp:
      return {p.x(), -p.z(), p.y()};
    case FileAxes::kYUpZAhead:
      return body::FromYUp(p);
  }
  return p;
}

MarkerTracks ToWorld(FileAxes axes, MarkerTracks tracks) {
  for (Eigen::Matrix3Xd& track : tracks.p) {
    for (Eigen::Index frame = 0; frame < track.cols(); ++frame) {
      track.col(frame) = ToWorld(axes, Eigen::Vector3d(track.col(frame)));
    }
  }
  return tracks;
}

}  // namespace footing::motion
