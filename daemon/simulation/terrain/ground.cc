#include "daemon/simulation/terrain/ground.h"

#include <cmath>

namespace footing::terrain {
namespace {

std::string Geom(const GroundBox& box, const std::string& name = "") {
  const auto text = [](double value) { return std::to_string(value) + " "; };
  const Eigen::Vector3d& p = box.centre_W_m;
  const Eigen::Vector3d& half = box.half_size_m;
  const Eigen::Quaterniond& q = box.q_WS;
  return "<geom" + (name.empty() ? "" : " name='" + name + "'") +
         " type='box' contype='1' conaffinity='2' size='" + text(half.x()) + text(half.y()) +
         text(half.z()) + "' pos='" + text(p.x()) + text(p.y()) + text(p.z()) + "' quat='" +
         text(q.w()) + text(q.x()) + text(q.y()) + text(q.z()) + "'/>\n";
}

}  // namespace

bool IsLevel(const stream::Track& track) { return !track.extendable && IsFlat(track); }

bool HasPlane(const stream::Track& track) {
  return IsLevel(track) && (track.open || track.endless);
}

double RibbonHeight(const stream::TrackSegment& segment, const TrackPlace& place) {
  return segment.start_m.z() + place.along_m * std::sin(segment.slope_rad);
}

double RibbonHeight(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  return RibbonHeight(track.segments[static_cast<std::size_t>(place.segment)], place);
}

double GroundHeight(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  const stream::TrackSegment& segment = track.segments[static_cast<std::size_t>(place.segment)];
  const double height_m = RibbonHeight(segment, place);
  return segment.pit ? height_m - kPitDepthM : height_m;
}

GroundBox WaitingBox(int index) {
  constexpr double kDepthM = 100, kApartM = 10;
  return {{kApartM * index, 0, -kDepthM}, Eigen::Quaterniond::Identity(), {1, 1, 1}};
}

std::string GroundBoxName(int index) { return "ground_" + std::to_string(index); }

std::string GroundMjcf(const stream::Track& track) {
  if (track.extendable) {
    std::string boxes;
    for (int i = 0; i < kGroundBoxes; ++i) boxes += Geom(WaitingBox(i), GroundBoxName(i));
    return boxes;
  }
  if (HasPlane(track)) {
    return "<geom type='plane' contype='1' conaffinity='2' size='0 0 1'/>\n";
  }
  std::string text;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    if (!track.segments[i].pit) text += Geom(BoxOf(track, i));
  }
  return text;
}

}  // namespace footing::terrain
