#include "common/body/centre_line.h"

#include <algorithm>
#include <cmath>

namespace footing::track {
namespace {

/// Segments that are this much further are as near: where two meet the earlier one counts.
constexpr double kRoundingM = 1e-9;

/// Distance from the nearest start of a segment, m. The centre line is not further.
double NearestStart(const stream::Track& track, const Eigen::Vector2d& p_W_m) {
  double squared_m2 = INFINITY;
  for (const stream::TrackSegment& segment : track.segments) {
    squared_m2 = std::min(squared_m2, (p_W_m - segment.start_m.head<2>()).squaredNorm());
  }
  return std::sqrt(squared_m2);
}

}  // namespace

TrackPlace Locate(const stream::Track& track, const Eigen::Vector2d& p_W_m) {
  const double nearest_start_m = NearestStart(track, p_W_m);
  TrackPlace nearest;
  nearest.distance_m = INFINITY;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const Eigen::Vector2d offset = p_W_m - segment.start_m.head<2>();
    const double reach_m = segment.length_m + nearest_start_m + kRoundingM;
    if (offset.squaredNorm() > reach_m * reach_m) continue;  // Saves the sines of far segments.
    const Eigen::Vector2d ahead(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
    const Eigen::Vector2d left(-ahead.y(), ahead.x());
    const double level_m = segment.length_m * std::cos(segment.slope_rad);
    const double along_m = std::clamp(offset.dot(ahead), 0.0, level_m);
    const double distance_m = (offset - along_m * ahead).norm();
    if (distance_m >= nearest.distance_m) continue;
    nearest = {static_cast<int>(i), along_m / std::cos(segment.slope_rad), offset.dot(left),
               distance_m};
  }
  return nearest;
}

bool IsOffRibbon(const stream::Track& track, const TrackPlace& place) {
  return place.distance_m > track.segments[static_cast<std::size_t>(place.segment)].width_m / 2;
}

double LengthTo(const stream::Track& track, const TrackPlace& place) {
  double length_m = track.first_m + place.along_m;
  for (int i = 0; i < place.segment; ++i) {
    length_m += track.segments[static_cast<std::size_t>(i)].length_m;
  }
  return length_m;
}

double LengthOf(const stream::Track& track) {
  const int last = static_cast<int>(track.segments.size()) - 1;
  return LengthTo(track, {last, track.segments.back().length_m, 0, 0});
}

TrackPlace PlaceAt(const stream::Track& track, double length_m) {
  double along_m = std::max(0.0, length_m - track.first_m);
  std::size_t index = 0;
  while (along_m > track.segments[index].length_m && index + 1 < track.segments.size()) {
    along_m -= track.segments[index].length_m;
    ++index;
  }
  return {static_cast<int>(index), std::min(along_m, track.segments[index].length_m), 0, 0};
}

namespace {

CentrePoint On(const stream::TrackSegment& segment, double along_m) {
  const double level_m = along_m * std::cos(segment.slope_rad);
  return {segment.start_m + Eigen::Vector3d(level_m * std::cos(segment.heading_rad),
                                            level_m * std::sin(segment.heading_rad),
                                            along_m * std::sin(segment.slope_rad)),
          segment.heading_rad};
}

/// A place along a segment, moved off the edges of pits before and behind it; between two pits
/// nearer than both margins its middle.
double OffPits(const stream::Track& track, int index, double along_m) {
  constexpr double kMarginM = 0.5;
  const auto i = static_cast<std::size_t>(index);
  const double length_m = track.segments[i].length_m;
  const bool pit_behind = i > 0 && track.segments[i - 1].pit;
  const bool pit_ahead = i + 1 < track.segments.size() && track.segments[i + 1].pit;
  const double least_m = pit_behind ? kMarginM : 0;
  const double most_m = pit_ahead ? length_m - kMarginM : length_m;
  return least_m < most_m ? std::clamp(along_m, least_m, most_m) : length_m / 2;
}

}  // namespace

CentrePoint CentreBehind(const stream::Track& track, const TrackPlace& place, double back_m) {
  int index = place.segment;
  double along_m = place.along_m - back_m;
  while (index > 0 && (along_m < 0 || track.segments[index].pit)) {
    if (along_m > 0) along_m = 0;  // In a pit: its near edge.
    --index;
    along_m += track.segments[index].length_m;
  }
  return On(track.segments[index], OffPits(track, index, std::max(along_m, 0.0)));
}

CentrePoint CentreAhead(const stream::Track& track, const TrackPlace& place, double ahead_m) {
  auto index = static_cast<std::size_t>(place.segment);
  double along_m = place.along_m + ahead_m;
  while (along_m > track.segments[index].length_m && index + 1 < track.segments.size()) {
    along_m -= track.segments[index].length_m;
    ++index;
  }
  return On(track.segments[index], std::min(along_m, track.segments[index].length_m));
}

stream::TrackSegment Placed(const Piece& piece, const stream::TrackSegment& last) {
  stream::TrackSegment placed = stream::Following(last);
  placed.length_m = piece.length_m;
  placed.width_m = last.width_m;
  placed.slope_rad = piece.slope_rad;
  placed.heading_rad += piece.curve_rad;
  placed.start_m.z() += piece.step_m;
  placed.pit = piece.pit;
  return placed;
}

}  // namespace footing::track
