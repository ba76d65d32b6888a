#include "common/camera/lens.h"

#include <cmath>

namespace footing::sphere {
namespace {

/// Brown's model: radial factor and tangential shift.
struct Bend {
  double factor;
  Eigen::Vector2d shift;
};

Bend BendAt(const Lens& lens, const Eigen::Vector2d& at) {
  const double x = at.x(), y = at.y(), r2 = x * x + y * y;
  return {1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3)),
          {2 * lens.p1 * x * y + lens.p2 * (r2 + 2 * x * x),
           lens.p1 * (r2 + 2 * y * y) + 2 * lens.p2 * x * y}};
}

bool IsIn(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

Eigen::Vector2d ToPixel(const Lens& lens, const Eigen::Vector2d& slopes) {
  const Bend bend = BendAt(lens, slopes);
  const Eigen::Vector2d at = bend.factor * slopes + bend.shift;
  return {lens.cx_px + lens.fx_px * at.x(), lens.cy_px + lens.fy_px * at.y()};
}

Eigen::Vector2d Undistort(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d seen((pixel.x() - lens.cx_px) / lens.fx_px,
                             (pixel.y() - lens.cy_px) / lens.fy_px);
  Eigen::Vector2d at = seen;
  // The usual fixed-point iteration: each round divides the error by about 1/k1 r² or more.
  for (int i = 0; i < 40; ++i) {
    const Bend bend = BendAt(lens, at);
    const Eigen::Vector2d next = (seen - bend.shift) / bend.factor;
    const double moved = (next - at).squaredNorm();
    at = next;
    if (moved < 1e-20) break;
  }
  return at;
}

std::string Problem(const Lens& lens) {
  for (const int size : {lens.width, lens.height}) {
    if (size < 32 || size > 4096 || size % 2 != 0) return "sizes must be even, from 32 to 4096";
  }
  for (const double f : {lens.fx_px, lens.fy_px}) {
    if (!IsIn(f, 0.2 * lens.width, 20 * lens.width))
      return "focal lengths must be from 0.2 to 20 times the width";
  }
  if (!IsIn(lens.cx_px, 0, lens.width - 1) || !IsIn(lens.cy_px, 0, lens.height - 1))
    return "the principal point must be in the image";
  for (int i = 0; i <= 8; ++i) {
    for (int k = 0; k <= 8; ++k) {
      const Eigen::Vector2d pixel(i * (lens.width - 1) / 8.0, k * (lens.height - 1) / 8.0);
      const Eigen::Vector2d again = ToPixel(lens, Undistort(lens, pixel));
      if (!((again - pixel).norm() < 0.01)) return "the distortion cannot be undone at the edges";
    }
  }
  return "";
}

}  // namespace footing::sphere
