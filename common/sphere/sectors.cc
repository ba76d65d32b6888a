#include "common/sphere/sectors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace footing::sphere {

Sectors SectorsOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes,
                  const std::vector<Eigen::Vector2d>& outshone) {
  constexpr double kNear = 1.6 * 2 * std::numbers::pi / kSectors;
  enum class Kind { kInlier, kOutlier, kOutshone };
  struct Polar {
    double angle, distance;
    Kind kind;
  };
  std::vector<Polar> edges;
  const auto add = [&](const Eigen::Vector2d& at, Kind kind) {
    const Eigen::Vector2d from = at - fit.cone.axis;
    edges.push_back({std::atan2(from.y(), from.x()), from.norm(), kind});
  };
  for (std::size_t i = 0; i < slopes.size(); ++i)
    add(slopes[i], fit.inliers[i] ? Kind::kInlier : Kind::kOutlier);
  for (const Eigen::Vector2d& at : outshone) add(at, Kind::kOutshone);
  Sectors sectors;
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double middle = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    double nearest = fit.cone.tangent;
    std::array<int, 3> count{};
    for (const Polar& edge : edges) {
      const double apart = std::abs(edge.angle - middle);  // Up to one and a half turns.
      if (std::min(apart, std::abs(apart - 2 * std::numbers::pi)) > kNear) continue;
      ++count[static_cast<std::size_t>(edge.kind)];
      if (edge.kind == Kind::kOutlier) nearest = std::min(nearest, edge.distance);
    }
    const auto [inliers, outliers, bright] = count;
    sectors.outshone[s] = bright > outliers && bright >= inliers;
    if (sectors.outshone[s] || inliers > outliers) {
      sectors.reach[s] = std::numeric_limits<double>::infinity();
    } else {
      sectors.reach[s] = outliers > 0 ? nearest : 0;
    }
  }
  return sectors;
}

}  // namespace footing::sphere
