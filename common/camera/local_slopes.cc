#include "common/camera/local_slopes.h"

#include <Eigen/Geometry>

namespace footing::sphere {

LocalSlopes::LocalSlopes(const Lens& lens, const Eigen::Vector2d& middle, double half_px)
    : middle_(middle), half_px_(half_px) {
  const Eigen::Vector2d ahead = Undistort(lens, middle);
  R_CL_.col(2) = Eigen::Vector3d(ahead.x(), ahead.y(), 1).normalized();
  R_CL_.col(0) = Eigen::Vector3d::UnitY().cross(R_CL_.col(2)).normalized();
  R_CL_.col(1) = R_CL_.col(2).cross(R_CL_.col(0));
  // Values at x, y in {-1, 0, 1}, then the polynomial through them, first along x, then along y.
  Eigen::Vector2d node[3][3];
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d slopes =
          Undistort(lens, middle + half_px * Eigen::Vector2d(i - 1, j - 1));
      const Eigen::Vector3d ray_L = R_CL_.transpose() * Eigen::Vector3d(slopes.x(), slopes.y(), 1);
      node[j][i] = ray_L.head<2>() / ray_L.z();
    }
  }
  const auto quadratic = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c, Eigen::Vector2d out[3]) {
    out[0] = b;
    out[1] = 0.5 * (c - a);
    out[2] = 0.5 * (a + c) - b;
  };
  Eigen::Vector2d row[3][3], column[3];
  for (int j = 0; j < 3; ++j) quadratic(node[j][0], node[j][1], node[j][2], row[j]);
  for (int i = 0; i < 3; ++i) {
    quadratic(row[0][i], row[1][i], row[2][i], column);
    for (int j = 0; j < 3; ++j) terms_.col(3 * j + i) = column[j];
  }
  scale_.col(0) = terms_.col(1) / half_px;
  scale_.col(1) = terms_.col(3) / half_px;
}

Eigen::Matrix2d LocalSlopes::ScaleChange(int axis) const {
  Eigen::Matrix2d change;
  change.col(axis) = 2 * terms_.col(axis == 0 ? 2 : 6);
  change.col(1 - axis) = terms_.col(4);
  return change / (half_px_ * half_px_);
}

Eigen::Vector2d LocalSlopes::At(double u, double v) const {
  const double x = (u - middle_.x()) / half_px_, y = (v - middle_.y()) / half_px_;
  const auto row = [&](int j) -> Eigen::Vector2d {
    return terms_.col(3 * j) + x * (terms_.col(3 * j + 1) + x * terms_.col(3 * j + 2));
  };
  return row(0) + y * (row(1) + y * row(2));
}

}  // namespace footing::sphere
