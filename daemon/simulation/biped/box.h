#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>

#include "common/stream/character.h"

namespace footing::terrain {

/// A segment's ground as a solid box.
struct GroundBox {
  Eigen::Vector3d centre_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WS = Eigen::Quaterniond::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
};

/// The box under a segment; its top face is the ground. Where the track turns, two boxes would
/// leave a wedge open on the outer side: one of them reaches under the other to close it, the lower
/// one, so that a step begins where the track has it. A pit's edges stay where they are. The first
/// segment has no `previous` and begins before the start, so that one can stand on the line; the
/// last one has no `next`.
GroundBox BoxOf(const stream::TrackSegment* previous, const stream::TrackSegment& segment,
                const stream::TrackSegment* next);
/// The same by its place in the track.
GroundBox BoxOf(const stream::Track& track, std::size_t index);

}  // namespace footing::terrain
