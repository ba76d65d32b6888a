#include "daemon/simulation/biped/endless.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::terrain {
namespace {

constexpr double kSegmentM = 2;
constexpr double kCourseM = 10;
/// Largest curve between two segments (gait paper, section 8.2).
constexpr double kSharpestRad = DegreesToRadians(15);
/// The segments aim at a point of the character's course so far beyond the track's end.
constexpr double kAimM = 8;
/// A character that has hardly moved has no course: the track goes straight on.
constexpr double kLeastCourse = 0.05;

double LengthAhead(const stream::Track& track, const TrackPlace& place) {
  double length_m = -place.along_m;
  for (auto i = static_cast<std::size_t>(place.segment); i < track.segments.size(); ++i) {
    length_m += track.segments[i].length_m;
  }
  return length_m;
}

}  // namespace

void FollowCourse(const Eigen::Vector2d& moved_m, Eigen::Vector2d& course) {
  const double distance_m = moved_m.norm();
  if (distance_m == 0) return;
  const double share = std::min(1.0, distance_m / kCourseM);
  course += share * (moved_m / distance_m - course);
}

std::optional<stream::TrackSegment> EndlessSegment(const stream::Track& track,
                                                   const TrackPlace& place,
                                                   const Eigen::Vector2d& p_W_m,
                                                   const Eigen::Vector2d& course) {
  const bool off = IsOffRibbon(track, place);
  if (!off && LengthAhead(track, place) >= kEndlessAheadM) return std::nullopt;
  stream::TrackSegment next = Following(track.segments.back());
  next.length_m = kSegmentM;
  next.width_m = track.segments.back().width_m;
  const bool has_course = course.norm() >= kLeastCourse;
  if (off) {
    next.start_m.head<2>() = p_W_m;
    if (has_course) next.heading_rad = std::atan2(course.y(), course.x());
    return next;
  }
  if (!has_course) return next;
  const Eigen::Vector2d end_m = next.start_m.head<2>();
  const Eigen::Vector2d aim_m = p_W_m + ((end_m - p_W_m).norm() + kAimM) * course.normalized();
  const Eigen::Vector2d way_m = aim_m - end_m;
  const double turn_rad = WrapAngle(std::atan2(way_m.y(), way_m.x()) - next.heading_rad);
  next.heading_rad += std::clamp(turn_rad, -kSharpestRad, kSharpestRad);
  return next;
}

}  // namespace footing::terrain
