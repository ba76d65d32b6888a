#include "daemon/simulation/biped/box.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"

namespace footing::terrain {
namespace {

constexpr double kHalfThicknessM = 1.0;
/// Ground before the start, where a character stands with its feet on the line.
constexpr double kBeforeStartM = 3.0;
/// Smaller differences of height are rounding.
constexpr double kLeastStepM = 1e-6;

/// How far the lower one of two boxes must reach under the other for their outer corners to meet:
/// half the width times the sine of the turn, beyond a right angle half the width.
double Reach(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  if (near.pit || far.pit) return 0;
  const double turn_rad = std::fabs(WrapAngle(far.heading_rad - near.heading_rad));
  return far.width_m / 2 * std::sin(std::min(turn_rad, kPi / 2));
}

bool StepsUp(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  return far.start_m.z() > Following(near).start_m.z() + kLeastStepM;
}

double ReachBack(const stream::TrackSegment* previous, const stream::TrackSegment& segment) {
  if (previous == nullptr) return kBeforeStartM;
  return StepsUp(*previous, segment) ? 0 : Reach(*previous, segment);
}

double ReachAhead(const stream::TrackSegment& segment, const stream::TrackSegment* next) {
  return next != nullptr && StepsUp(segment, *next) ? Reach(segment, *next) : 0;
}

}  // namespace

GroundBox BoxOf(const stream::TrackSegment* previous, const stream::TrackSegment& segment,
                const stream::TrackSegment* next) {
  const double back_m = ReachBack(previous, segment);
  const double half_m = (segment.length_m + back_m + ReachAhead(segment, next)) / 2;
  const Eigen::Quaterniond q_WS(Eigen::AngleAxisd(segment.heading_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-segment.slope_rad, Eigen::Vector3d::UnitY()));
  return {segment.start_m + q_WS * Eigen::Vector3d(half_m - back_m, 0, -kHalfThicknessM),
          q_WS,
          {half_m, segment.width_m / 2, kHalfThicknessM}};
}

GroundBox BoxOf(const stream::Track& track, std::size_t index) {
  const stream::TrackSegment* segment = &track.segments[index];
  const bool last = index + 1 == track.segments.size();
  return BoxOf(index > 0 ? segment - 1 : nullptr, *segment, last ? nullptr : segment + 1);
}

}  // namespace footing::terrain
