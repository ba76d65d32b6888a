#include "common/camera/cone.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace footing::sphere {
namespace {

constexpr int kTries = 60;

/// Solves (s, t, 1) . w = |(s, t, 1)| by its normal equations; w.z() comes less 1, since the rays
/// are nearly parallel. Slopes are scaled to be of the order of 1.
class ConeEquations {
 public:
  explicit ConeEquations(double scale) : scale_(scale) {}
  void Add(const Eigen::Vector2d& slopes) {
    const Eigen::Vector3d row(slopes.x() / scale_, slopes.y() / scale_, 1);
    const double r2 = slopes.squaredNorm();
    const double length_less_1 = r2 / (1 + std::sqrt(1 + r2));
    normal_ += row * row.transpose();
    right_ += row * (length_less_1 / (scale_ * scale_));
  }
  std::optional<Cone> Solve() const {
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal_);
    if (solver.info() != Eigen::Success || !(solver.vectorD().minCoeff() > 1e-9))
      return std::nullopt;
    const Eigen::Vector3d w = solver.solve(right_);
    // |w|² - 1 = tan² of the half angle.
    const double third = scale_ * scale_ * w.z();
    const Eigen::Vector2d lateral = scale_ * w.head<2>();
    const double tangent2 = lateral.squaredNorm() + third * (2 + third);
    if (!(tangent2 > 0)) return std::nullopt;
    return Cone{lateral / (1 + third), std::sqrt(tangent2)};
  }

 private:
  double scale_;
  Eigen::Matrix3d normal_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_ = Eigen::Vector3d::Zero();
};

double ScaleOf(const std::vector<Eigen::Vector2d>& slopes) {
  double largest = 1e-6;
  for (const auto& one : slopes) largest = std::max(largest, one.norm());
  return largest;
}

}  // namespace

double Beyond(const Cone& cone, const Eigen::Vector2d& slopes) {
  return (slopes - cone.axis).norm() - cone.tangent;
}

std::optional<Cone> FitCone(const std::vector<Eigen::Vector2d>& slopes,
                            const std::vector<bool>& use) {
  ConeEquations equations(ScaleOf(slopes));
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    if (use[i]) equations.Add(slopes[i]);
  }
  return equations.Solve();
}

std::optional<ConeFit> FitConeRobustly(const std::vector<Eigen::Vector2d>& slopes, double tolerance,
                                       double narrowest, double widest) {
  const std::size_t count = slopes.size();
  if (count < 5) return std::nullopt;
  const double scale = ScaleOf(slopes);
  std::optional<Cone> best;
  std::size_t most = 0;
  std::uint32_t state = 12345;  // The same three points for the same picture.
  const auto pick = [&state, count] {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::size_t>(state >> 8) % count;
  };
  for (int i = 0; i < kTries; ++i) {
    ConeEquations equations(scale);
    for (int k = 0; k < 3; ++k) equations.Add(slopes[pick()]);
    const auto cone = equations.Solve();
    if (!cone || cone->tangent < narrowest || cone->tangent > widest) continue;
    const auto inside = static_cast<std::size_t>(std::count_if(
        slopes.begin(), slopes.end(),
        [&](const Eigen::Vector2d& one) { return std::abs(Beyond(*cone, one)) < tolerance; }));
    if (inside <= most) continue;
    most = inside;
    best = cone;
    if (10 * inside >= 9 * count) break;
  }
  if (!best || most < 5) return std::nullopt;
  ConeFit fit{*best, std::vector<bool>(count)};
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < count; ++i)
      fit.inliers[i] = std::abs(Beyond(fit.cone, slopes[i])) < tolerance;
    const auto again = FitCone(slopes, fit.inliers);
    if (!again || again->tangent < narrowest || again->tangent > widest) break;
    fit.cone = *again;
  }
  return fit;
}

}  // namespace footing::sphere
