#include "daemon/offline/analysis/leg_gap.h"

#include <algorithm>
#include <cmath>

namespace footing::legs {
namespace {

constexpr double kLegRadiusM = 0.02;
constexpr int kHips[] = {1, 3};  // Indices into EngineOutput::links: the origins are the hips.

double Share(double part, double whole) {
  return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0;
}

}  // namespace

double DistanceBetween(const Segment& first, const Segment& second) {
  const Eigen::Vector3d u = first.to_m - first.from_m;
  const Eigen::Vector3d v = second.to_m - second.from_m;
  const Eigen::Vector3d offset = first.from_m - second.from_m;
  const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm();
  const double u_offset = u.dot(offset), v_offset = v.dot(offset);
  double along_first = Share(uv * v_offset - u_offset * vv, uu * vv - uv * uv);
  const double along_second = Share(uv * along_first + v_offset, vv);
  along_first = Share(uv * along_second - u_offset, uu);
  return (offset + along_first * u - along_second * v).norm();
}

double LegGap(const engine::EngineOutput& output) {
  const auto leg = [&output](int side) {
    const Eigen::Vector3d bottom_m = output.contacts[static_cast<std::size_t>(side)].position_m;
    return Segment{output.links[static_cast<std::size_t>(kHips[side])].position_m,
                   bottom_m + Eigen::Vector3d(0, 0, kLegRadiusM)};
  };
  return DistanceBetween(leg(0), leg(1)) - 2 * kLegRadiusM;
}

}  // namespace footing::legs
