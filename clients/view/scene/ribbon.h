#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/stream/character.h"

/// The course of a track: where its surface lies, apart from how it is painted.
namespace footing::scene {

inline constexpr std::size_t kMostSegments = 2000;  ///< More are not drawn.
inline constexpr float kPitDepthM = 0.6f;

/// Distance by which a segment's edges run back or on, per metre to the left of the centre line:
/// where the track turns, both segments end on the line that halves the turn.
struct Mitre {
  double start = 0;  ///< Along offset of the start, over sideways.
  double end = 0;    ///< The same of the end, which runs on.
};

/// Mitre of the track's segment `i`.
Mitre MitreOf(const stream::Track& track, std::size_t i);

/// A place on the centre line: neighbours share the places between them to the last bit, so that no
/// pixel shows what is below.
struct Station {
  Eigen::Vector3f centre, left, up;
  float half_width, along_m;

  Eigen::Vector3f Edge(float side) const { return centre + side * half_width * left; }
};

/// The stretches of surface without a gap, each as its stations from the start on. Bends are
/// curves, at most 1 m to either side of each joint; an endless track goes on for its fade.
std::vector<std::vector<Station>> RunsOf(const stream::Track& track);

/// Lengths along the track between which it fades away; both 0: it does not.
struct Fade {
  float from_m = 0;
  float to_m = 0;
};
/// An endless track fades from the end of what is laid so far.
Fade FadeOf(const stream::Track& track);

/// Height of the track under a point; `ground_m` beside it and in pits.
double HeightAt(const stream::Track& track, const Eigen::Vector2d& p_m, double ground_m);

/// Height of the ground around the track: just below its lowest corner; 0 without a track.
double GroundHeight(const stream::Track& track);

/// A corner of the track's surface.
struct RibbonVertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  float along_m;     ///< From the track's start along its centre line.
  float sideways_m;  ///< From the centre line, left positive.
  float half_width_m;
  float kind;  ///< 0 surface, 1 pit, 2 side, 3 white paint, 4 yellow paint.
};

/// Triangles of a track's ribbon.
struct RibbonMesh {
  std::vector<RibbonVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// The track as triangles: top faces, pits as sunken dark floors, the sides down to the ground,
/// the distance painted on every tenth metre, and the lines of a trial: start, finish, mark and,
/// where a track has tasks, the middle. At most kMostSegments are drawn. Bends are drawn as curves,
/// at most 1 m to either side of each joint. An endless track goes on for its fade.
RibbonMesh BuildRibbon(const stream::Track& track);

/// A painted stroke: an axis-aligned rectangle, corners in letter heights; x to the right, y up.
struct Stroke {
  Eigen::Vector2f low;
  Eigen::Vector2f high;
};

/// Seven-segment digits of height 1 and width 0.55, centred on the origin. Only the characters 0 to
/// 9 are painted; others leave a gap.
std::vector<Stroke> PaintNumber(const std::string& digits);

/// A vertex of a solid mesh.
struct MeshVertex {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
};

/// Triangles, counter-clockwise from outside.
struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;
};

/// Sphere of radius 1. `slices` around z, `stacks` from pole to pole; both at least 3.
Mesh UnitBall(int slices, int stacks);

/// Cube of side 1 about the origin.
Mesh UnitBox();

/// Radius 1 about z from z = 0 to 1, open at the ends that its neighbours hide; the bottom is
/// closed. The renderer tapers its top.
Mesh UnitRod(int slices);

/// A rod with round ends: two half spheres of radius 1 about z, joined by a side. The z of a vertex
/// is 0 at the first end and 1 at the second one; its normal says where on the half sphere it lies.
/// The renderer gives the ends their radii and the rod its length. `stacks` is of one half sphere.
Mesh UnitLimb(int slices, int stacks);

}  // namespace footing::scene
