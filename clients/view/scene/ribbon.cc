#include "clients/view/scene/ribbon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

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

namespace {

constexpr double kNumberEveryM = 10;
constexpr float kNumberHeightM = 0.5f;
constexpr float kPaintM = 0.004f;

constexpr float kLineM = 0.12f;    // Start line and middle line.
constexpr float kMarkM = 0.35f;    // The mark, seen from afar.
constexpr float kSquareM = 0.25f;  // Side of a square of the finish line.
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

namespace {

constexpr float kWidth = 0.55f;
constexpr float kPen = 0.13f;
constexpr float kAdvance = 0.75f;

// Bits 0 to 6: top, upper right, lower right, bottom, lower left, upper left, middle.
constexpr std::array<unsigned, 10> kSegments{0x3f, 0x06, 0x5b, 0x4f, 0x66,
                                             0x6d, 0x7d, 0x07, 0x7f, 0x6f};

Stroke Segment(int index) {
  const float right = kWidth - kPen;
  const float middle = 0.5f - kPen / 2;
  switch (index) {
    case 0:
      return {{0, 1 - kPen}, {kWidth, 1}};
    case 1:
      return {{right, 0.5f}, {kWidth, 1}};
    case 2:
      return {{right, 0}, {kWidth, 0.5f}};
    case 3:
      return {{0, 0}, {kWidth, kPen}};
    case 4:
      return {{0, 0}, {kPen, 0.5f}};
    case 5:
      return {{0, 0.5f}, {kPen, 1}};
    default:
      return {{0, middle}, {kWidth, middle + kPen}};
  }
}

}  // namespace

std::vector<Stroke> PaintNumber(const std::string& digits) {
  std::vector<Stroke> strokes;
  const float width = kAdvance * static_cast<float>(digits.size()) - (kAdvance - kWidth);
  Eigen::Vector2f origin(-width / 2, -0.5f);
  for (const char digit : digits) {
    if (digit >= '0' && digit <= '9') {
      for (int segment = 0; segment < 7; ++segment) {
        if ((kSegments[static_cast<std::size_t>(digit - '0')] >> segment & 1) == 0) continue;
        const Stroke stroke = Segment(segment);
        strokes.push_back({origin + stroke.low, origin + stroke.high});
      }
    }
    origin.x() += kAdvance;
  }
  return strokes;
}

namespace {

Eigen::Vector3f OnCircle(int slice, int slices, float radius, float z) {
  const float angle = static_cast<float>(2 * kPi) * static_cast<float>(slice) / slices;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Joins two rings of slices + 1 vertices each into triangles.
void JoinRings(int lower, int upper, int slices, std::vector<std::uint32_t>& indices) {
  for (int i = 0; i < slices; ++i) {
    const auto a = static_cast<std::uint32_t>(lower + i), b = a + 1;
    const auto c = static_cast<std::uint32_t>(upper + i), d = c + 1;
    indices.insert(indices.end(), {a, b, d, a, d, c});
  }
}

}  // namespace

Mesh UnitBall(int slices, int stacks) {
  Mesh mesh;
  for (int stack = 0; stack <= stacks; ++stack) {
    const float angle = static_cast<float>(kPi) * static_cast<float>(stack) / stacks;
    for (int slice = 0; slice <= slices; ++slice) {
      const Eigen::Vector3f p = OnCircle(slice, slices, std::sin(angle), -std::cos(angle));
      mesh.vertices.push_back({p, p});
    }
    if (stack > 0)
      JoinRings((stack - 1) * (slices + 1), stack * (slices + 1), slices, mesh.indices);
  }
  return mesh;
}

Mesh UnitBox() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-0.5f, 0.5f}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      Eigen::Vector3f normal = Eigen::Vector3f::Zero();
      normal[axis] = 2 * side;
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3f p = 0.5f * normal;
        p[(axis + 1) % 3] = (corner & 1) != 0 ? side : -side;
        p[(axis + 2) % 3] = (corner & 2) != 0 ? 0.5f : -0.5f;
        mesh.vertices.push_back({p, normal});
      }
      mesh.indices.insert(mesh.indices.end(),
                          {first, first + 1, first + 3, first, first + 3, first + 2});
    }
  }
  return mesh;
}

Mesh UnitRod(int slices) {
  Mesh mesh;
  for (const float z : {0.0f, 1.0f}) {
    for (int slice = 0; slice <= slices; ++slice) {
      mesh.vertices.push_back({OnCircle(slice, slices, 1, z), OnCircle(slice, slices, 1, 0)});
    }
  }
  JoinRings(0, slices + 1, slices, mesh.indices);
  const auto centre = static_cast<std::uint32_t>(mesh.vertices.size());
  const Eigen::Vector3f down(0, 0, -1);
  mesh.vertices.push_back({Eigen::Vector3f::Zero(), down});
  for (int slice = 0; slice <= slices; ++slice) {
    mesh.vertices.push_back({OnCircle(slice, slices, 1, 0), down});
  }
  for (int slice = 0; slice < slices; ++slice) {
    const auto rim = centre + 1 + static_cast<std::uint32_t>(slice);
    mesh.indices.insert(mesh.indices.end(), {centre, rim + 1, rim});
  }
  return mesh;
}

Mesh UnitLimb(int slices, int stacks) {
  Mesh mesh;
  for (int ring = 0; ring <= 2 * stacks + 1; ++ring) {
    const bool second = ring > stacks;
    const int stack = second ? ring - 1 : ring;  // The equator is there twice, once for each end.
    const float angle = static_cast<float>(kPi) * static_cast<float>(stack) / (2 * stacks);
    for (int slice = 0; slice <= slices; ++slice) {
      const Eigen::Vector3f n = OnCircle(slice, slices, std::sin(angle), -std::cos(angle));
      mesh.vertices.push_back({{n.x(), n.y(), second ? 1.0f : 0.0f}, n});
    }
    if (ring > 0) JoinRings((ring - 1) * (slices + 1), ring * (slices + 1), slices, mesh.indices);
  }
  return mesh;
}

}  // namespace footing::scene
