#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace footing::sphere {

/// The cone of rays that touch a sphere, in slopes of a frame whose third axis is near the cone's:
/// a ray's coordinates are (s, t, 1).
struct Cone {
  Eigen::Vector2d axis{0, 0};  ///< Slopes of its axis.
  double tangent = 0;          ///< Of its half angle.
};

struct ConeFit {
  Cone cone;
  std::vector<bool> inliers;  ///< Of the points.
};

/// Least squares on unit rays u of the silhouette: u . w = 1 with w along the axis and |w| =
/// 1/cos of the half angle; linear, no ellipse. Nothing with fewer than three points or when they
/// lie on no cone.
std::optional<Cone> FitCone(const std::vector<Eigen::Vector2d>& slopes,
                            const std::vector<bool>& use);

/// The same by consensus: the cone through three points that has the most others within
/// `tolerance` of its edge, in slopes, fitted again to those. Its half angle's tangent is within
/// `narrowest` and `widest`.
std::optional<ConeFit> FitConeRobustly(const std::vector<Eigen::Vector2d>& slopes, double tolerance,
                                       double narrowest, double widest);

/// How far a ray is outside of the cone, in slopes.
double Beyond(const Cone& cone, const Eigen::Vector2d& slopes);

}  // namespace footing::sphere
