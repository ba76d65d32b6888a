#include "clients/view/scene/ribbon.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "clients/view/scene/digits.h"
#include "common/units/units.h"

namespace footing::scene {
namespace {

constexpr std::size_t kMaxSegments = 2000;
constexpr float kPitDepthM = 0.6f;
constexpr float kBelowM = 0.03f;  // The ground lies this far under the lowest corner.
constexpr double kNumberEveryM = 10;
constexpr float kNumberHeightM = 0.5f;
constexpr float kPaintM = 0.004f;

constexpr float kLineM = 0.12f;    // Start line and middle line.
constexpr float kMarkM = 0.35f;    // The mark, seen from afar.
constexpr float kSquareM = 0.25f;  // Of the finish line.
constexpr float kBorderM = 0.15f;  // Between a line across the track and its edge.

enum Kind { kSurface = 0, kPit = 1, kSide = 2, kWhite = 3, kYellow = 4 };

/// A segment's own frame: along its slope, to its left, square to its face.
struct SegmentFrame {
  Eigen::Vector3f start, along, left, up;
  float length, half_width;

  explicit SegmentFrame(const stream::TrackSegment& s)
      : start(s.start_m.cast<float>()),
        along(Eigen::Vector3d(std::cos(s.slope_rad) * std::cos(s.heading_rad),
                              std::cos(s.slope_rad) * std::sin(s.heading_rad),
                              std::sin(s.slope_rad))
                  .cast<float>()),
        left(Eigen::Vector3d(-std::sin(s.heading_rad), std::cos(s.heading_rad), 0).cast<float>()),
        up(along.cross(left)),
        length(static_cast<float>(s.length_m)),
        half_width(static_cast<float>(s.width_m) / 2) {}

  Eigen::Vector3f At(float along_m, float left_m, float up_m) const {
    return start + along_m * along + left_m * left + up_m * up;
  }
};

/// How far a segment's edges run back or on, per metre to the left of the centre line: where the
/// track turns, both segments end on the line that halves the turn.
struct Mitre {
  double start = 0;  ///< Along offset of the start, over sideways.
  double end = 0;    ///< The same of the end, which runs on.
};

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

class Painter {
 public:
  explicit Painter(RibbonMesh& mesh) : mesh_(mesh) {}

  void Quad(const SegmentFrame& frame, float from_m, Eigen::Vector2f low, Eigen::Vector2f high,
            float up_m, Kind kind) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const Eigen::Vector2f& p :
         {Eigen::Vector2f(low.x(), low.y()), Eigen::Vector2f(high.x(), low.y()),
          Eigen::Vector2f(high.x(), high.y()), Eigen::Vector2f(low.x(), high.y())}) {
      mesh_.vertices.push_back({frame.At(p.x(), p.y(), up_m), frame.up, from_m + p.x(), p.y(),
                                frame.half_width, static_cast<float>(kind)});
    }
    Face(first);
  }

  /// The whole face of a segment, with mitred ends.
  void Face(const SegmentFrame& frame, float from_m, const Mitre& mitre, float up_m, Kind kind) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const float w = frame.half_width;
    for (const Eigen::Vector2f& p :
         {StartAt(mitre, -w), EndAt(frame, mitre, -w), EndAt(frame, mitre, w), StartAt(mitre, w)}) {
      mesh_.vertices.push_back({frame.At(p.x(), p.y(), up_m), frame.up, from_m + p.x(), p.y(), w,
                                static_cast<float>(kind)});
    }
    Face(first);
  }

  void Walls(const SegmentFrame& frame, const Mitre& mitre, float ground) {
    const float w = frame.half_width;
    const auto at = [&frame](const Eigen::Vector2f& p) { return frame.At(p.x(), p.y(), 0); };
    const Eigen::Vector3f a = at(StartAt(mitre, -w)), b = at(EndAt(frame, mitre, -w));
    const Eigen::Vector3f c = at(EndAt(frame, mitre, w)), d = at(StartAt(mitre, w));
    Wall(a, b, ground);
    Wall(c, d, ground);
    Wall(d, a, ground);
    Wall(b, c, ground);
  }

  /// From an upper edge a-b straight down to height `ground`.
  void Wall(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float ground) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const Eigen::Vector3f normal = (a - b).cross(Eigen::Vector3f::UnitZ()).normalized();
    for (const Eigen::Vector3f& p : {a, b}) Corner(p, normal);
    for (const Eigen::Vector3f& p : {b, a}) Corner({p.x(), p.y(), ground}, normal);
    Face(first);
  }

 private:
  static Eigen::Vector2f StartAt(const Mitre& mitre, float left_m) {
    return {left_m * static_cast<float>(mitre.start), left_m};
  }
  static Eigen::Vector2f EndAt(const SegmentFrame& frame, const Mitre& mitre, float left_m) {
    return {frame.length + left_m * static_cast<float>(mitre.end), left_m};
  }
  void Corner(const Eigen::Vector3f& p, const Eigen::Vector3f& normal) {
    mesh_.vertices.push_back({p, normal, 0, 0, 1, static_cast<float>(kSide)});
  }
  void Face(std::uint32_t first) {
    mesh_.indices.insert(mesh_.indices.end(),
                         {first, first + 1, first + 2, first, first + 2, first + 3});
  }
  RibbonMesh& mesh_;
};

void PaintNumbers(Painter& painter, const SegmentFrame& frame, double from_m) {
  const double to_m = from_m + static_cast<double>(frame.length);
  const auto first = static_cast<int>(std::ceil(from_m / kNumberEveryM));
  for (int mark = std::max(first, 1); mark * kNumberEveryM < to_m; ++mark) {
    const auto at = static_cast<float>(mark * kNumberEveryM - from_m) + kNumberHeightM;
    const auto text = std::to_string(mark * static_cast<int>(kNumberEveryM));
    const float aside = -frame.half_width + 0.75f;
    for (const Stroke& stroke : PaintNumber(text)) {
      // A letter's x is to the right, which is minus left; its y is along the track.
      const Eigen::Vector2f low(at + kNumberHeightM * stroke.low.y(),
                                aside - kNumberHeightM * stroke.high.x());
      const Eigen::Vector2f high(at + kNumberHeightM * stroke.high.y(),
                                 aside - kNumberHeightM * stroke.low.x());
      if (high.x() > frame.length) continue;
      painter.Quad(frame, static_cast<float>(from_m), low, high, kPaintM, kWhite);
    }
  }
}

/// A line across the segment, so much of it along the track.
void PaintAcross(Painter& painter, const SegmentFrame& frame, double from_m, float at_m,
                 float thick_m, Kind kind) {
  const float side = frame.half_width - kBorderM;
  painter.Quad(frame, static_cast<float>(from_m), {at_m - thick_m / 2, -side},
               {at_m + thick_m / 2, side}, kPaintM, kind);
}

/// Squares, every other one white, in two rows.
void PaintFinish(Painter& painter, const SegmentFrame& frame, double from_m, float at_m) {
  const float side = frame.half_width - kBorderM;
  for (int row = 0; row < 2; ++row) {
    const float low = at_m + (static_cast<float>(row) - 1) * kSquareM;
    for (int i = row; static_cast<float>(i + 1) * kSquareM <= 2 * side; i += 2) {
      const float left = static_cast<float>(i) * kSquareM - side;
      painter.Quad(frame, static_cast<float>(from_m), {low, left},
                   {low + kSquareM, left + kSquareM}, kPaintM, kWhite);
    }
  }
}

void PaintLines(Painter& painter, const stream::Track& track, const SegmentFrame& frame,
                double from_m) {
  const auto on_segment = [&](double at_m, float& local_m) {
    local_m = static_cast<float>(at_m - from_m);
    return local_m >= 0 && local_m < frame.length;
  };
  float at_m = 0;
  if (!track.tasks.empty()) {
    painter.Quad(frame, static_cast<float>(from_m), {0, -kLineM / 2}, {frame.length, kLineM / 2},
                 kPaintM / 2, kWhite);
    if (on_segment(track.mark_m, at_m)) {
      PaintAcross(painter, frame, from_m, at_m, kMarkM, kYellow);
    }
  }
  if (track.finish_m <= 0) return;
  if (on_segment(track.start_m, at_m)) PaintAcross(painter, frame, from_m, at_m, kLineM, kWhite);
  if (on_segment(track.finish_m, at_m)) PaintFinish(painter, frame, from_m, at_m);
}

}  // namespace

RibbonMesh BuildRibbon(const stream::Track& track) {
  RibbonMesh mesh;
  Painter painter(mesh);
  const auto ground = static_cast<float>(GroundHeight(track)) - 0.05f;
  double from_m = track.first_m;
  const std::size_t count = std::min(track.segments.size(), kMaxSegments);
  for (std::size_t i = 0; i < count; ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const SegmentFrame frame(segment);
    const Mitre mitre = MitreOf(track, i);
    painter.Face(frame, static_cast<float>(from_m), mitre, segment.pit ? -kPitDepthM : 0,
                 segment.pit ? kPit : kSurface);
    if (!segment.pit) {
      painter.Walls(frame, mitre, ground);
      PaintNumbers(painter, frame, from_m);
      PaintLines(painter, track, frame, from_m);
    }
    from_m += segment.length_m;
  }
  return mesh;
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
