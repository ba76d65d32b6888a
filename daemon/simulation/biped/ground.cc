#include "daemon/simulation/biped/ground.h"

#include <algorithm>
#include <cmath>

namespace footing::terrain {
namespace {

std::string Geom(const GroundBox& box, const std::string& name) {
  const auto text = [](double value) { return std::to_string(value) + " "; };
  const Eigen::Vector3d& p = box.centre_W_m;
  const Eigen::Vector3d& half = box.half_size_m;
  const Eigen::Quaterniond& q = box.q_WS;
  return "<geom name='" + name + "' type='box' contype='1' conaffinity='2' size='" +
         text(half.x()) + text(half.y()) + text(half.z()) + "' pos='" + text(p.x()) + text(p.y()) +
         text(p.z()) + "' quat='" + text(q.w()) + text(q.x()) + text(q.y()) + text(q.z()) + "'/>\n";
}

constexpr int kBoxesBehind = 8;  ///< Of an extendable track.
constexpr double kReachM = 2.5;  ///< Of the character, with its next steps.

/// Segments within reach of segment `from`'s end, stepping by `by`.
int WithinReach(const stream::Track& track, int from, int by) {
  const int count = static_cast<int>(track.segments.size());
  double length_m = 0;
  int reached = 0;
  for (int i = from + by; i >= 0 && i < count && length_m < kReachM; i += by) {
    length_m += track.segments[static_cast<std::size_t>(i)].length_m;
    ++reached;
  }
  return reached;
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

GroundWindow WindowOf(const stream::Track& track) {
  if (track.extendable) return {kGroundBoxes, kBoxesBehind};
  if (Grows(track) || HasPlane(track)) return {};
  const int count = static_cast<int>(track.segments.size());
  int behind = 0, ahead = 0;
  for (int i = 0; i < count; ++i) {
    behind = std::max(behind, WithinReach(track, i, -1));
    ahead = std::max(ahead, WithinReach(track, i, 1));
  }
  const int boxes = behind + 1 + ahead;
  return boxes < std::min(count, kGroundBoxes) ? GroundWindow{boxes, behind} : GroundWindow{};
}

GroundBox WaitingBox(int index) {
  constexpr double kDepthM = 100, kApartM = 10;
  return {{kApartM * index, 0, -kDepthM}, Eigen::Quaterniond::Identity(), {1, 1, 1}};
}

std::string GroundBoxName(int index) { return "ground_" + std::to_string(index); }

GroundText GroundMjcf(const stream::Track& track) {
  GroundText ground;
  const auto add = [&ground](const GroundBox& box, std::size_t index) {
    ground.names.push_back(GroundBoxName(static_cast<int>(index)));
    ground.mjcf += Geom(box, ground.names.back());
  };
  if (const GroundWindow window = WindowOf(track); window.boxes > 0) {
    for (int i = 0; i < window.boxes; ++i) add(WaitingBox(i), static_cast<std::size_t>(i));
    return ground;
  }
  if (HasPlane(track)) {
    return {"<geom name='ground' type='plane' contype='1' conaffinity='2' size='0 0 1'/>\n",
            {"ground"}};
  }
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    if (!track.segments[i].pit) add(BoxOf(track, i), i);
  }
  return ground;
}

}  // namespace footing::terrain
