#include "daemon/simulation/biped/ground.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
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

namespace {

/// `exact`: as PlaceBox of world.h places it, to the last bit.
std::string Geom(const GroundBox& box, const std::string& name, bool exact = false) {
  const auto text = [exact](double value) {
    return (exact ? text::Shortest(value) : std::to_string(value)) + " ";
  };
  const Eigen::Vector3d& p = box.centre_W_m;
  const Eigen::Vector3d& half = box.half_size_m;
  const Eigen::Quaterniond& q = box.q_WS;
  return "<geom name='" + name + "' type='box' contype='1' conaffinity='2' size='" +
         text(half.x()) + text(half.y()) + text(half.z()) + "' pos='" + text(p.x()) + text(p.y()) +
         text(p.z()) + "' quat='" + text(q.w()) + text(q.x()) + text(q.y()) + text(q.z()) + "'/>\n";
}

constexpr int kBoxesBehind = 8;  ///< Boxes of an extendable track behind the character.
constexpr double kReachM = 2.5;  ///< Reach of the character, with its next steps.

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
  const GroundWindow window = WindowOf(track);
  if (window.boxes == 0) return WholeGroundMjcf(track);
  GroundText ground;
  for (int i = 0; i < window.boxes; ++i) {
    ground.names.push_back(GroundBoxName(i));
    ground.mjcf += Geom(WaitingBox(i), ground.names.back());
  }
  return ground;
}

GroundText WholeGroundMjcf(const stream::Track& track) {
  if (HasPlane(track)) {
    return {"<geom name='ground' type='plane' contype='1' conaffinity='2' size='0 0 1'/>\n",
            {"ground"}};
  }
  GroundText ground;
  const bool exact = WindowOf(track).boxes > 0;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    if (track.segments[i].pit) continue;
    ground.names.push_back(GroundBoxName(static_cast<int>(i)));
    ground.mjcf += Geom(BoxOf(track, i), ground.names.back(), exact);
  }
  return ground;
}

namespace {

/// The edge between two segments, one after the other; without distance where there is none.
Edge Between(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  Edge edge;
  const double end_m = near.start_m.z() + near.length_m * std::sin(near.slope_rad);
  edge.rise_m = far.start_m.z() - end_m;
  edge.pit = near.pit || far.pit;
  return edge;
}

bool IsEdge(const Edge& edge) { return edge.pit || std::fabs(edge.rise_m) > kLowestEdgeM; }

}  // namespace

Spot Survey(const stream::Track& track, double x_m, double y_m) {
  const TrackPlace place = Locate(track, {x_m, y_m});
  const auto index = static_cast<std::size_t>(place.segment);
  const stream::TrackSegment& here = track.segments[index];
  const double ribbon_m = here.start_m.z() + place.along_m * std::sin(here.slope_rad);
  Spot spot;
  spot.height_m = here.pit ? ribbon_m - kPitDepthM : ribbon_m;
  spot.slope = std::tan(here.slope_rad);
  spot.heading_rad = here.heading_rad;
  spot.pit = here.pit;
  const double level = std::cos(here.slope_rad);
  if (index > 0) {
    Edge edge = Between(track.segments[index - 1], here);
    edge.distance_m = place.along_m * level;
    if (IsEdge(edge)) spot.behind = edge;
  }
  if (index + 1 < track.segments.size()) {
    Edge edge = Between(here, track.segments[index + 1]);
    edge.distance_m = (here.length_m - place.along_m) * level;
    if (IsEdge(edge)) spot.ahead = edge;
  }
  return spot;
}

}  // namespace footing::terrain
