#include "clients/view/scene/ribbon.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "clients/view/scene/course.h"
#include "clients/view/scene/digits.h"

namespace footing::scene {
namespace {

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

  /// The floor of a pit, with mitred ends.
  void Pit(const SegmentFrame& frame, float from_m, const Mitre& mitre) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const float w = frame.half_width;
    for (const Eigen::Vector2f& p :
         {StartAt(mitre, -w), EndAt(frame, mitre, -w), EndAt(frame, mitre, w), StartAt(mitre, w)}) {
      mesh_.vertices.push_back({frame.At(p.x(), p.y(), -kPitDepthM), frame.up, from_m + p.x(),
                                p.y(), w, static_cast<float>(kPit)});
    }
    Face(first);
  }

  /// The surface between two stations, and its walls down to the ground.
  void Piece(const Station& a, const Station& b, float ground) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (const auto& [station, side] :
         {std::pair(&a, -1.0f), {&b, -1.0f}, {&b, 1.0f}, {&a, 1.0f}}) {
      mesh_.vertices.push_back({station->Edge(side), station->up, station->along_m,
                                side * station->half_width, station->half_width,
                                static_cast<float>(kSurface)});
    }
    Face(first);
    Wall(a.Edge(-1), b.Edge(-1), ground, a.along_m, b.along_m);
    Wall(b.Edge(1), a.Edge(1), ground, b.along_m, a.along_m);
  }

  /// A stretch of surface without a gap, with walls around it.
  void Run(const std::vector<Station>& run, float ground) {
    for (std::size_t i = 1; i < run.size(); ++i) Piece(run[i - 1], run[i], ground);
    const Station &first = run.front(), &last = run.back();
    Wall(first.Edge(1), first.Edge(-1), ground, first.along_m, first.along_m);
    Wall(last.Edge(-1), last.Edge(1), ground, last.along_m, last.along_m);
  }

  /// From an upper edge a-b straight down to height `ground`.
  void Wall(const Eigen::Vector3f& a, const Eigen::Vector3f& b, float ground, float along_a,
            float along_b) {
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    const Eigen::Vector3f normal = (a - b).cross(Eigen::Vector3f::UnitZ()).normalized();
    Corner(a, normal, along_a);
    Corner(b, normal, along_b);
    Corner({b.x(), b.y(), ground}, normal, along_b);
    Corner({a.x(), a.y(), ground}, normal, along_a);
    Face(first);
  }

 private:
  static Eigen::Vector2f StartAt(const Mitre& mitre, float left_m) {
    return {left_m * static_cast<float>(mitre.start), left_m};
  }
  static Eigen::Vector2f EndAt(const SegmentFrame& frame, const Mitre& mitre, float left_m) {
    return {frame.length + left_m * static_cast<float>(mitre.end), left_m};
  }
  void Corner(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, float along_m) {
    mesh_.vertices.push_back({p, normal, along_m, 0, 1, static_cast<float>(kSide)});
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
  for (const std::vector<Station>& run : RunsOf(track)) painter.Run(run, ground);
  double from_m = track.first_m;
  const std::size_t count = std::min(track.segments.size(), kMostSegments);
  for (std::size_t i = 0; i < count; ++i) {
    const stream::TrackSegment& segment = track.segments[i];
    const SegmentFrame frame(segment);
    if (segment.pit) {
      painter.Pit(frame, static_cast<float>(from_m), MitreOf(track, i));
    } else {
      PaintNumbers(painter, frame, from_m);
      PaintLines(painter, track, frame, from_m);
    }
    from_m += segment.length_m;
  }
  return mesh;
}

}  // namespace footing::scene
