#include "daemon/simulation/terrain/ground.h"

#include <algorithm>
#include <cmath>

#include "daemon/simulation/terrain/track.h"

namespace footing::terrain {
namespace {

constexpr double kHalfThicknessM = 1.0;
/// The first segment's ground begins this much before its start, where the character stands.
constexpr double kBeforeStartM = 3.0;

/// `before_m` lengthens it backwards.
std::string Box(const stream::TrackSegment& segment, double before_m) {
  const double half_m = (segment.length_m + before_m) / 2;
  const Eigen::Matrix3d R_WS = (Eigen::AngleAxisd(segment.heading_rad, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-segment.slope_rad, Eigen::Vector3d::UnitY()))
                                   .toRotationMatrix();
  const Eigen::Vector3d centre =
      segment.start_m + R_WS * Eigen::Vector3d(half_m - before_m, 0, -kHalfThicknessM);
  const Eigen::Quaterniond q(R_WS);
  const auto text = [](double value) { return std::to_string(value) + " "; };
  return "<geom type='box' contype='1' conaffinity='2' size='" + text(half_m) +
         text(segment.width_m / 2) + text(kHalfThicknessM) + "' pos='" + text(centre.x()) +
         text(centre.y()) + text(centre.z()) + "' quat='" + text(q.w()) + text(q.x()) +
         text(q.y()) + text(q.z()) + "'/>\n";
}

}  // namespace

bool IsLevel(const stream::Track& track) {
  return std::all_of(track.segments.begin(), track.segments.end(), [](const auto& segment) {
    return !segment.pit && segment.slope_rad == 0 && segment.start_m.z() == 0;
  });
}

double RibbonHeight(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
  return segment.start_m.z() + place.along_m * std::sin(segment.slope_rad);
}

double GroundHeight(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
  const double height_m = segment.start_m.z() + place.along_m * std::sin(segment.slope_rad);
  return segment.pit ? height_m - kPitDepthM : height_m;
}

std::string GroundMjcf(const stream::Track& track) {
  if (IsLevel(track)) {
    return "<geom type='plane' contype='1' conaffinity='2' size='0 0 1'/>\n";
  }
  std::string text;
  for (const stream::TrackSegment& segment : track.segments) {
    const bool first = &segment == &track.segments.front();
    if (!segment.pit) text += Box(segment, first ? kBeforeStartM : 0);
  }
  return text;
}

}  // namespace footing::terrain
