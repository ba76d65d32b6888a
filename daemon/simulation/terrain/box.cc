#include "daemon/simulation/terrain/box.h"

#include <algorithm>
#include <cmath>

#include "common/units/units.h"

namespace footing::terrain {
namespace {

constexpr double kHalfThicknessM = 1.0;
/// Ground before the start, where a character stands with its feet on the line.
constexpr double kBeforeStartM = 3.0;

/// How far back the near edge must reach for its outer corner to meet the previous box's: half the
/// width times the sine of the turn, beyond a right angle half the width.
double ReachBack(const stream::TrackSegment* previous, const stream::TrackSegment& segment) {
  if (previous == nullptr) return kBeforeStartM;
  if (previous->pit) return 0;
  const double turn_rad = std::fabs(WrapAngle(segment.heading_rad - previous->heading_rad));
  return segment.width_m / 2 * std::sin(std::min(turn_rad, kPi / 2));
}

}  // namespace

GroundBox BoxOf(const stream::TrackSegment* previous, const stream::TrackSegment& segment) {
  const double back_m = ReachBack(previous, segment);
  const double half_m = (segment.length_m + back_m) / 2;
  const Eigen::Quaterniond q_WS(Eigen::AngleAxisd(segment.heading_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-segment.slope_rad, Eigen::Vector3d::UnitY()));
  return {segment.start_m + q_WS * Eigen::Vector3d(half_m - back_m, 0, -kHalfThicknessM),
          q_WS,
          {half_m, segment.width_m / 2, kHalfThicknessM}};
}

}  // namespace footing::terrain
