#include "daemon/simulation/biped/track.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::terrain {

bool Grows(const stream::Track& track) { return track.extendable || track.endless; }

bool IsFlat(const stream::Track& track) {
  return std::all_of(track.segments.begin(), track.segments.end(), [](const auto& segment) {
    return !segment.pit && segment.slope_rad == 0 && segment.start_m.z() == 0;
  });
}

stream::Track WithPitsFilled(stream::Track track) {
  for (stream::TrackSegment& segment : track.segments) segment.pit = false;
  return track;
}

namespace {

constexpr double kSlack = 1e-9;
constexpr double kStepsApartM = 1.0;
/// A step is a jump of height between two segments of more than this, m.
constexpr double kIsStepM = 1e-6;
/// A new segment stays this far, beside the ribbon's width, from all that lies further back than
/// kOwnBendM.
constexpr double kClearM = 0.5;
constexpr double kOwnBendM = 12;

bool Within(double value, double limit) { return std::fabs(value) <= limit + kSlack; }

/// Length from the last step to the track's end.
double SinceStep(const stream::Track& track) {
  double length_m = 0;
  for (std::size_t i = track.segments.size() - 1; i > 0 && length_m < kStepsApartM; --i) {
    length_m += track.segments[i].length_m;
    const double end_m = Following(track.segments[i - 1]).start_m.z();
    if (std::fabs(track.segments[i].start_m.z() - end_m) > kIsStepM) return length_m;
  }
  return std::max(length_m, kStepsApartM);
}

bool RunsIntoItself(const stream::Track& track, const stream::TrackSegment& placed) {
  const Eigen::Vector2d from = placed.start_m.head<2>();
  const Eigen::Vector2d to = Following(placed).start_m.head<2>();
  double back_m = 0;
  for (std::size_t i = track.segments.size(); i-- > 0;) {
    const stream::TrackSegment& old = track.segments[i];
    back_m += old.length_m;
    if (back_m - old.length_m < kOwnBendM) continue;
    const double clear_m = old.width_m + kClearM;
    // The old segment's middle reaches half its length around it.
    const Eigen::Vector2d middle = (old.start_m + Following(old).start_m).head<2>() / 2;
    const double reach_m = clear_m + old.length_m / 2;
    const Eigen::Vector2d nearest =
        from + std::clamp((middle - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0) *
                   (to - from);
    if ((nearest - middle).norm() < reach_m) return true;
  }
  return false;
}

const char* WhyOutOfRange(const NewSegment& segment) {
  const double least_m = segment.pit ? 0.3 : 2.0, most_m = segment.pit ? 1.5 : 4.0;
  const bool length = segment.length_m >= least_m - kSlack && segment.length_m <= most_m + kSlack;
  if (!length) {
    return segment.pit ? "the length of a pit must be 0.3 to 1.5 m" : "the length must be 2 to 4 m";
  }
  if (!Within(segment.slope_rad, DegreesToRadians(5))) return "the slope must be within 5 degrees";
  if (!Within(segment.curve_rad, DegreesToRadians(15)))
    return "the curve must be within 15 degrees";
  if (!Within(segment.step_m, 0.10)) return "the step must be within 0.10 m";
  const bool plain = segment.slope_rad == 0 && segment.curve_rad == 0 && segment.step_m == 0;
  if (segment.pit && !plain) return "a pit has no slope, curve or step; put them after it";
  return nullptr;
}

}  // namespace

std::size_t MostSegments(const stream::Track& track) {
  return track.endless ? kMostEndlessSegments : kMostSegments;
}

const char* WhyNotAppended(const stream::Track& track, const NewSegment& segment, int here) {
  if (!track.extendable) return "this track cannot be extended; start with the track \"build\"";
  if (const char* why = WhyOutOfRange(segment); why != nullptr) return why;
  const stream::TrackSegment& last = track.segments.back();
  if (segment.pit && last.pit) return "a pit follows a pit; put 2 m of ground between them";
  if (last.pit && segment.curve_rad != 0) return "no curve right after a pit; curve one later";
  if (segment.step_m != 0 && SinceStep(track) < kStepsApartM - kSlack) {
    return "two steps must be at least 1 m apart";
  }
  if (track.segments.size() >= kMostSegments && here < kKeptBehind) {
    return "the track is full; wait until the character has moved on";
  }
  if (RunsIntoItself(track, track::Placed(segment, last))) {
    return "the track would run into itself; curve the other way";
  }
  return nullptr;
}

void Append(const NewSegment& segment, stream::Track& track) {
  Add(track::Placed(segment, track.segments.back()), track);
}

void Add(const stream::TrackSegment& placed, stream::Track& track) {
  if (track.segments.size() >= MostSegments(track)) {
    track.first_m += track.segments.front().length_m;
    track.segments.erase(track.segments.begin());
  }
  track.segments.push_back(placed);
  ++track.revision;
}

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
