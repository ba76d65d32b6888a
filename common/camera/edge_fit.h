#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/camera/cone.h"
#include "common/camera/disc_fit.h"
#include "common/camera/local_slopes.h"

namespace footing::sphere {

/// Which sectors have the cone's edge, and up to where the others show the sphere.
SectorReach ReachOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes);

/// A sphere whose light no photometric fit explains, as one before the edge of a lamp: its cone as
/// the edges give it, with a covariance that follows from them. Its direction is good to a
/// fraction of a pixel, its distance is rough. `inliers` are those of `start.edges`; `radius_sd_px`
/// is what they have in common beside the usual. Nothing when they are too few.
std::optional<DiscFit> FitEdge(const LocalSlopes& slopes, const DiscStart& start,
                               const std::vector<bool>& inliers, double radius_sd_px);

}  // namespace footing::sphere
