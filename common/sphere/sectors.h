#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "common/sphere/cone.h"
#include "common/sphere/disc_fit.h"

namespace footing::sphere {

/// What is known of each sector's edge.
struct Sectors {
  SectorReach reach;
  std::array<bool, kSectors> outshone{};
};

/// Which sectors have the cone's edge, and up to where the others show the sphere. `outshone` are
/// slopes at which a brighter light begins: nothing hides the sphere there.
Sectors SectorsOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes,
                  const std::vector<Eigen::Vector2d>& outshone);

}  // namespace footing::sphere
