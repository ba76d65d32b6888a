#include "daemon/simulation/terrain/track.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/units/units.h"

namespace footing::terrain {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxSegments = 1000;

/// Reads numbers out of one JSON object and remembers the first thing wrong.
class Fields {
 public:
  Fields(const json& object, std::string where) : object_(object), where_(std::move(where)) {}

  double Number(const char* key, double fallback, double min, double max) {
    if (!object_.contains(key)) return fallback;
    const json& value = object_[key];
    if (value.is_number() && value.get<double>() >= min && value.get<double>() <= max) {
      return value.get<double>();
    }
    Fail(std::string(key) + " is " + value.dump() + ", allowed is a number from " +
         std::to_string(min) + " to " + std::to_string(max));
    return fallback;
  }

  void Fail(const std::string& what) {
    if (error_.empty()) error_ = where_ + ": " + what;
  }
  const std::string& error() const { return error_; }

 private:
  const json& object_;
  std::string where_;
  std::string error_;
};

Result<void> AppendFrom(const json& object, const std::string& where, double width_m,
                        stream::Track& track) {
  if (!object.is_object()) return InvalidData(where + ": a segment is an object {length_m, ...}");
  Fields fields(object, where);
  stream::TrackSegment segment =
      track.segments.empty() ? stream::TrackSegment{} : Following(track.segments.back());
  segment.width_m = width_m;
  segment.length_m = fields.Number("length_m", 0, 0.01, 10000);
  if (segment.length_m == 0) fields.Fail("length_m is missing");
  segment.slope_rad = DegreesToRadians(fields.Number("slope_deg", 0, -30, 30));
  segment.heading_rad += DegreesToRadians(fields.Number("curve_deg", 0, -90, 90));
  segment.start_m.z() += fields.Number("step_m", 0, -0.5, 0.5);
  segment.pit = object.contains("pit") && object["pit"] == true;
  if (!fields.error().empty()) return InvalidData(fields.error());
  track.segments.push_back(segment);
  return {};
}

/// What an extendable track's file must keep to.
Result<void> CheckExtendable(const stream::Track& track, const std::string& origin) {
  constexpr std::size_t kMost = 32;
  constexpr double kShortestM = 2;
  bool fits = track.segments.size() <= kMost;
  for (const stream::TrackSegment& segment : track.segments) {
    fits = fits && segment.length_m >= kShortestM;
  }
  if (fits) return {};
  return InvalidData(origin + ": an extendable track starts with 1 to 32 segments of at least 2 m");
}

}  // namespace

stream::TrackSegment Following(const stream::TrackSegment& last) {
  stream::TrackSegment next;
  const double level_m = last.length_m * std::cos(last.slope_rad);
  next.start_m = last.start_m + Eigen::Vector3d(level_m * std::cos(last.heading_rad),
                                                level_m * std::sin(last.heading_rad),
                                                last.length_m * std::sin(last.slope_rad));
  next.heading_rad = last.heading_rad;
  return next;
}

Result<stream::Track> ParseTrack(const std::string& text, const std::string& origin) {
  const json root = json::parse(text, nullptr, false, true);
  if (!root.is_object()) return InvalidData(origin + ": not a JSON object");
  Fields fields(root, origin);
  if (fields.Number("version", 0, 0, 1e9) != 1) {
    return InvalidData(origin + ": version must be 1, the only one known");
  }
  stream::Track track;
  track.revision = 1;
  track.extendable = root.contains("extendable") && root["extendable"] == true;
  track.open = root.contains("open") && root["open"] == true;
  track.name = root.contains("name") && root["name"].is_string() ? root["name"] : json("unnamed");
  const double width_m = fields.Number("width_m", 4, 0.1, 100);
  if (!fields.error().empty()) return InvalidData(fields.error());
  const json segments = root.value("segments", json());
  if (!segments.is_array() || segments.empty() || segments.size() > kMaxSegments) {
    return InvalidData(origin + ": segments must be a list of 1 to " +
                       std::to_string(kMaxSegments));
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string where = origin + ", segment " + std::to_string(i);
    if (auto appended = AppendFrom(segments[i], where, width_m, track); !appended) {
      return appended.error();
    }
  }
  if (track.extendable) {
    if (auto checked = CheckExtendable(track, origin); !checked) return checked.error();
  }
  return track;
}

TrackPlace Locate(const stream::Track& track, const Eigen::Vector2d& p_W_m) {
  TrackPlace nearest;
  nearest.distance_m = INFINITY;
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const Eigen::Vector2d offset = p_W_m - segment.start_m.head<2>();
    const double reach_m = segment.length_m + nearest.distance_m;
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
  double length_m = place.along_m;
  for (int i = 0; i < place.segment; ++i) {
    length_m += track.segments[static_cast<std::size_t>(i)].length_m;
  }
  return length_m;
}

double LengthOf(const stream::Track& track) {
  const int last = static_cast<int>(track.segments.size()) - 1;
  return LengthTo(track, {last, track.segments.back().length_m, 0, 0});
}

namespace {

CentrePoint On(const stream::TrackSegment& segment, double along_m) {
  const double level_m = along_m * std::cos(segment.slope_rad);
  return {segment.start_m + Eigen::Vector3d(level_m * std::cos(segment.heading_rad),
                                            level_m * std::sin(segment.heading_rad),
                                            along_m * std::sin(segment.slope_rad)),
          segment.heading_rad};
}

}  // namespace

namespace {

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

}  // namespace footing::terrain
