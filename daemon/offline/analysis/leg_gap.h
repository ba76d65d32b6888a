#pragma once

#include <Eigen/Core>

#include "daemon/simulation/engine/engine.h"

namespace footing::legs {

/// A straight line between two points, m.
struct Segment {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
};

/// The least distance between points of two segments, m (Ericson, Real-Time Collision Detection,
/// 5.1.9).
double DistanceBetween(const Segment& first, const Segment& second);

/// The gap between the legs as capsules from hip to foot, as thick as the foot's ball (4 cm);
/// negative where they overlap, at least -4 cm. In a run or walk legs that never pass through each
/// other keep it above zero.
double LegGap(const engine::EngineOutput& output);

}  // namespace footing::legs
