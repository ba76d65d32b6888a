#include "clients/view/scene/course.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::scene {
namespace {

constexpr float kBelowM = 0.03f;  // The ground lies this far under the lowest corner.

// A bend is drawn as a curve that begins and ends this far from it, or at half a segment.
constexpr double kBendM = 1.0;
constexpr double kBendPieceRad = DegreesToRadians(1.5);
constexpr int kMostBendPieces = 16;
constexpr double kSharpestBendRad = DegreesToRadians(60);
constexpr double kJoinedM = 0.02;  // Ends that lie closer are one place.
constexpr double kBeyondM = 26;    // How far an endless track is drawn on.

Station StationAt(const Eigen::Vector3d& centre_m, double heading_rad, const Eigen::Vector3f& up,
                  const stream::TrackSegment& segment, double along_m) {
  const Eigen::Vector3d left(-std::sin(heading_rad), std::cos(heading_rad), 0);
  return {centre_m.cast<float>(), left.cast<float>(), up, static_cast<float>(segment.width_m) / 2,
          static_cast<float>(along_m)};
}

Eigen::Vector3d AlongOf(const stream::TrackSegment& s) {
  return {std::cos(s.slope_rad) * std::cos(s.heading_rad),
          std::cos(s.slope_rad) * std::sin(s.heading_rad), std::sin(s.slope_rad)};
}

/// Square to a segment's surface.
Eigen::Vector3f UpOf(const stream::TrackSegment& s) {
  const Eigen::Vector3d left(-std::sin(s.heading_rad), std::cos(s.heading_rad), 0);
  return AlongOf(s).cross(left).cast<float>();
}

/// Whether the surface goes on from one segment into the next one.
bool Joined(const stream::TrackSegment& a, const stream::TrackSegment& b) {
  return !a.pit && !b.pit && std::abs(a.width_m - b.width_m) < 1e-3 &&
         std::abs(WrapAngle(b.heading_rad - a.heading_rad)) < kSharpestBendRad &&
         (a.start_m + a.length_m * AlongOf(a) - b.start_m).norm() < kJoinedM;
}

/// Adds a station unless the last one is at its place: two curves may meet in the middle of a
/// segment.
void Add(const Station& station, std::vector<Station>& stations) {
  constexpr float kSamePlaceM = 1e-4f;
  if ((station.centre - stations.back().centre).norm() > kSamePlaceM) stations.push_back(station);
}

/// The stations of the joint between two segments: a curve that leaves the one and enters the other
/// without a kink. The height follows the segments, on which feet stand.
void AddJoint(const stream::TrackSegment& a, const stream::TrackSegment& b, double joint_m,
              std::vector<Station>& stations) {
  const double turn_rad = WrapAngle(b.heading_rad - a.heading_rad);
  const double reach_m = std::min({kBendM, a.length_m / 2, b.length_m / 2});
  const Eigen::Vector3f up_a = UpOf(a), up_b = UpOf(b);
  const auto half = std::clamp(static_cast<int>(std::ceil(std::abs(turn_rad) / kBendPieceRad / 2)),
                               0, kMostBendPieces / 2);
  if (half == 0) {
    Add(StationAt(b.start_m, b.heading_rad, (up_a + up_b).normalized(), b, joint_m), stations);
    return;
  }
  for (int i = 0; i <= 2 * half; ++i) {
    const double t = static_cast<double>(i) / (2 * half), from_joint_m = (2 * t - 1) * reach_m;
    const stream::TrackSegment& on = from_joint_m < 0 ? a : b;
    Eigen::Vector3d p_m = b.start_m + from_joint_m * AlongOf(on);
    // A quadratic Bezier curve about the joint; both of its legs are as long as the reach.
    p_m.head<2>() = b.start_m.head<2>() + reach_m * (t * t * AlongOf(b).head<2>() -
                                                     (1 - t) * (1 - t) * AlongOf(a).head<2>());
    const Eigen::Vector2d way = (1 - t) * AlongOf(a).head<2>() + t * AlongOf(b).head<2>();
    const Eigen::Vector3f up = 2 * i < 2 * half   ? up_a
                               : 2 * i > 2 * half ? up_b
                                                  : Eigen::Vector3f((up_a + up_b).normalized());
    Add(StationAt(p_m, std::atan2(way.y(), way.x()), up, b, joint_m + from_joint_m), stations);
  }
}

/// The heading of an end of a surface: towards a pit that the track turns into, it halves the turn.
double EndHeading(const stream::Track& track, std::size_t i, int side) {
  const double own_rad = track.segments[i].heading_rad;
  const bool first = side < 0 && i == 0, last = side > 0 && i + 1 >= track.segments.size();
  if (first || last) return own_rad;
  const double turn_rad = WrapAngle(track.segments[side < 0 ? i - 1 : i + 1].heading_rad - own_rad);
  return own_rad + (std::abs(turn_rad) < kSharpestBendRad ? turn_rad / 2 : 0);
}

/// An endless track is laid only a few metres ahead: it is drawn on, straight, for the fade.
void AddBeyond(std::vector<Station>& run) {
  Station beyond = run.back();
  const Eigen::Vector3f ahead(beyond.left.y(), -beyond.left.x(), 0);
  beyond.centre += static_cast<float>(kBeyondM) * ahead;
  beyond.along_m += static_cast<float>(kBeyondM);
  run.push_back(beyond);
}

}  // namespace

Mitre MitreOf(const stream::Track& track, std::size_t i) {
  const auto half_turn = [&](std::size_t before, std::size_t after) {
    const double turn_rad =
        WrapAngle(track.segments[after].heading_rad - track.segments[before].heading_rad);
    return std::tan(turn_rad / 2);
  };
  Mitre mitre;
  if (i > 0) mitre.start = half_turn(i - 1, i);
  if (i + 1 < track.segments.size()) mitre.end = -half_turn(i, i + 1);
  return mitre;
}

std::vector<std::vector<Station>> RunsOf(const stream::Track& track) {
  std::vector<std::vector<Station>> runs;
  double from_m = track.first_m;
  const std::size_t count = std::min(track.segments.size(), kMostSegments);
  bool begins = true;
  for (std::size_t i = 0; i < count; ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const double to_m = from_m + segment.length_m;
    const Eigen::Vector3f up = UpOf(segment);
    if (segment.pit) {
      begins = true;
      from_m = to_m;
      continue;
    }
    if (begins) {
      runs.push_back({StationAt(segment.start_m, EndHeading(track, i, -1), up, segment, from_m)});
    }
    begins = i + 1 >= count || !Joined(segment, track.segments[i + 1]);
    if (!begins) {
      AddJoint(segment, track.segments[i + 1], to_m, runs.back());
    } else {
      runs.back().push_back(StationAt(segment.start_m + segment.length_m * AlongOf(segment),
                                      EndHeading(track, i, 1), up, segment, to_m));
    }
    from_m = to_m;
  }
  if (track.endless && !runs.empty()) AddBeyond(runs.back());
  return runs;
}

Fade FadeOf(const stream::Track& track) {
  if (!track.endless || track.segments.empty()) return {};
  double end_m = track.first_m;
  for (const stream::TrackSegment& segment : track.segments) end_m += segment.length_m;
  return {static_cast<float>(end_m), static_cast<float>(end_m + kBeyondM)};
}

double HeightAt(const stream::Track& track, const Eigen::Vector2d& p_m, double ground_m) {
  for (std::size_t i = 0; i < track.segments.size(); ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const Mitre mitre = MitreOf(track, i);
    const Eigen::Vector2d forward(std::cos(segment.heading_rad), std::sin(segment.heading_rad));
    const Eigen::Vector2d from_start = p_m - segment.start_m.head<2>();
    const double along_m = from_start.dot(forward);
    const double sideways_m = forward.x() * from_start.y() - forward.y() * from_start.x();
    const double length_m = segment.length_m * std::cos(segment.slope_rad);
    if (along_m < mitre.start * sideways_m || along_m > length_m + mitre.end * sideways_m) continue;
    if (std::abs(sideways_m) > segment.width_m / 2 || segment.pit) continue;
    return segment.start_m.z() + along_m * std::tan(segment.slope_rad);
  }
  return ground_m;
}

double GroundHeight(const stream::Track& track) {
  if (track.segments.empty()) return 0;
  double lowest_m = track.segments.front().start_m.z();
  for (const stream::TrackSegment& segment : track.segments) {
    const double end_m = segment.start_m.z() + segment.length_m * std::sin(segment.slope_rad);
    const double floor_m = segment.pit ? static_cast<double>(kPitDepthM) : 0;
    lowest_m = std::min({lowest_m, segment.start_m.z() - floor_m, end_m - floor_m});
  }
  return lowest_m - static_cast<double>(kBelowM);
}

}  // namespace footing::scene
