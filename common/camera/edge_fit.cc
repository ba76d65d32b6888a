#include "common/camera/edge_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace footing::sphere {
namespace {

constexpr double kEdgeSdPx = 0.5;  // Of one edge, found between quads.
// What all edges share: a small blurred disc beside a brighter thing seems smaller or larger.
constexpr double kRadiusSdPx = 0.4;
constexpr double kQuadPx = 2;  // Rays that are nearer to each other see the same quads.
constexpr std::size_t kFewestEdges = 8;

}  // namespace

SectorReach ReachOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes) {
  constexpr double kNear = 1.6 * 2 * std::numbers::pi / kSectors;
  SectorReach reach;
  std::vector<Eigen::Vector2d> polar;  // Angle and distance of each edge.
  for (const Eigen::Vector2d& at : slopes) {
    const Eigen::Vector2d from = at - fit.cone.axis;
    polar.emplace_back(std::atan2(from.y(), from.x()), from.norm());
  }
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double middle = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    double nearest = fit.cone.tangent;
    int outliers = 0, inliers = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const double apart = std::abs(polar[i].x() - middle);  // Up to one and a half turns.
      if (std::min(apart, std::abs(apart - 2 * std::numbers::pi)) > kNear) continue;
      ++(fit.inliers[i] ? inliers : outliers);
      if (!fit.inliers[i]) nearest = std::min(nearest, polar[i].y());
    }
    if (inliers > outliers) {
      reach[s] = std::numeric_limits<double>::infinity();
    } else {
      reach[s] = outliers > 0 ? nearest : 0;
    }
  }
  return reach;
}

std::optional<DiscFit> FitEdge(const LocalSlopes& slopes, const DiscStart& start,
                               const std::vector<bool>& inliers, double radius_sd_px) {
  const double per_px = std::sqrt(slopes.scale().determinant());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  double square = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < inliers.size(); ++i) {
    if (!inliers[i]) continue;
    const Eigen::Vector2d unit = (start.edges[i] - start.cone.axis).normalized();
    const Eigen::Vector3d row(unit.x(), unit.y(), 1);
    const double beyond = Beyond(start.cone, start.edges[i]);
    normal += row * row.transpose();
    square += beyond * beyond;
    ++count;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  if (count < kFewestEdges || !(solver.vectorD().minCoeff() > 1e-6)) return std::nullopt;
  const double circumference_px = 2 * std::numbers::pi * start.cone.tangent / per_px;
  const double same = std::max(1.0, kEdgeRays * kQuadPx / circumference_px);
  const double edge_sd = std::max(kEdgeSdPx * per_px, std::sqrt(square / double(count)));
  DiscFit fit;
  fit.cone = start.cone;
  fit.covariance = same * edge_sd * edge_sd * solver.solve(Eigen::Matrix3d::Identity());
  fit.covariance(2, 2) += std::pow(std::hypot(kRadiusSdPx, radius_sd_px) * per_px, 2);
  fit.used_share = static_cast<double>(count) / kEdgeRays;
  fit.is_doubtful = true;
  return fit;
}

}  // namespace footing::sphere
