#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/stream/character.h"

namespace footing::terrain {

/// A segment's ground as a solid box.
struct GroundBox {
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WS = Eigen::Quaterniond::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// The box under a segment; its top face is the ground. Where the track turns, two boxes would
/// leave a wedge open on the outer side: the later one reaches back to close it. A pit's edges stay
/// where they are. The first segment has no `previous` and begins before the start, so that one can
/// stand on the line.
GroundBox BoxOf(const stream::TrackSegment* previous, const stream::TrackSegment& segment);

}  // namespace footing::terrain
