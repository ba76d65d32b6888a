#include "daemon/offline/eval/track_plan.h"

#include <array>
#include <cmath>

#include "common/base/units.h"
#include "daemon/simulation/biped/track.h"

namespace footing::eval {
namespace {

constexpr const char* kSurface = "#cfa791";
constexpr const char* kUphill = "#b9c98d";
constexpr const char* kDownhill = "#9db7d6";
constexpr const char* kPit = "#1b1b1f";
constexpr const char* kStep = "#8a4fa0";
constexpr const char* kStartLine = "#3d8b37";
constexpr const char* kMarkLine = "#e09a00";
constexpr const char* kFinishLine = "#c0202a";
/// Of a long track only the beginning is drawn, m.
constexpr double kMostDrawnM = 120;

using Corner = std::array<double, 2>;

Corner CornerAt(const stream::TrackSegment& segment, double along_m, double left_m) {
  const double c = std::cos(segment.heading_rad), s = std::sin(segment.heading_rad);
  const double level_m = along_m * std::cos(segment.slope_rad);
  return {segment.start_m.x() + level_m * c - left_m * s,
          segment.start_m.y() + level_m * s + left_m * c};
}

/// Along offset of a segment's end, over sideways, where it meets its neighbour in the middle of
/// their turn.
double HalfTurn(const stream::TrackSegment& near, const stream::TrackSegment& far) {
  return std::tan(WrapAngle(far.heading_rad - near.heading_rad) / 2);
}

const char* ColourOf(const stream::TrackSegment& segment) {
  if (segment.pit) return kPit;
  if (segment.slope_rad > 0) return kUphill;
  return segment.slope_rad < 0 ? kDownhill : kSurface;
}

plot::PlanShape AreaOf(const stream::Track& track, std::size_t i) {
  const stream::TrackSegment& segment = track.segments[i];
  const double half_m = segment.width_m / 2;
  const double length_m = std::min(segment.length_m, kMostDrawnM);
  const double start = i > 0 ? HalfTurn(track.segments[i - 1], segment) : 0;
  const bool last = i + 1 == track.segments.size();
  const double end = last ? 0 : -HalfTurn(segment, track.segments[i + 1]);
  return {{CornerAt(segment, -half_m * start, -half_m),
           CornerAt(segment, length_m - half_m * end, -half_m),
           CornerAt(segment, length_m + half_m * end, half_m),
           CornerAt(segment, half_m * start, half_m)},
          ColourOf(segment)};
}

void AddLine(const stream::Track& track, double at_m, const char* colour, plot::PlanPanel& panel) {
  double from_m = 0;
  for (const stream::TrackSegment& segment : track.segments) {
    if (at_m >= from_m && at_m < from_m + segment.length_m) {
      const double half_m = segment.width_m / 2;
      panel.shapes.push_back(
          {{CornerAt(segment, at_m - from_m, -half_m), CornerAt(segment, at_m - from_m, half_m)},
           colour});
      return;
    }
    from_m += segment.length_m;
  }
}

}  // namespace

plot::PlanPanel PlanOf(const std::string& name, const stream::Track& track) {
  plot::PlanPanel panel{name, {}};
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    panel.shapes.push_back(AreaOf(track, i));
  }
  double from_m = 0;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const bool step =
        i > 0 && std::fabs(track.segments[i].start_m.z() -
                           stream::Following(track.segments[i - 1]).start_m.z()) > 1e-6;
    if (step) AddLine(track, from_m, kStep, panel);
    from_m += track.segments[i].length_m;
  }
  if (track.finish_m > 0) {
    AddLine(track, track.start_m, kStartLine, panel);
    AddLine(track, track.finish_m, kFinishLine, panel);
  }
  if (track.mark_m > 0) AddLine(track, track.mark_m, kMarkLine, panel);
  return panel;
}

std::vector<plot::PlanKey> PlanKeys() {
  return {{kStartLine, "start"}, {kFinishLine, "finish"}, {kMarkLine, "mark"}, {kPit, "pit"},
          {kUphill, "uphill"},   {kDownhill, "downhill"}, {kStep, "step"}};
}

}  // namespace footing::eval
