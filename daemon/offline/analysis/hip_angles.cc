#include "daemon/offline/analysis/hip_angles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/base/rotation.h"
#include "common/base/units.h"

namespace footing::eval {

HipAngles HipAnglesDeg(const Eigen::Matrix3d& R_PT, int side) {
  const double outwards = side == 0 ? 1 : -1;
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ(), along = R_PT * down;
  const Eigen::Matrix3d about = LeastTurn(down, along).toRotationMatrix().transpose() * R_PT;
  return {RadiansToDegrees(std::atan2(along.x(), -along.z())),
          RadiansToDegrees(std::asin(std::clamp(outwards * along.y(), -1.0, 1.0))),
          RadiansToDegrees(-outwards * std::atan2(about(1, 0), about(0, 0)))};
}

HipAngles Difference(const HipAngles& a, const HipAngles& b) {
  const auto off = [](double one, double other) {
    return std::abs(std::remainder(one - other, 360.0));
  };
  return {off(a.flexion, b.flexion), off(a.abduction, b.abduction), off(a.rotation, b.rotation)};
}

}  // namespace footing::eval
