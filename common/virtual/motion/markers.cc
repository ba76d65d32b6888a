#include "common/virtual/motion/markers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "common/body/y_up.h"

namespace footing::motion {

int FindMarker(const MarkerTracks& tracks, std::string_view name) {
  for (std::size_t i = 0; i < tracks.names.size(); ++i) {
    if (tracks.names[i] == name) return static_cast<int>(i);
  }
  return -1;
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
