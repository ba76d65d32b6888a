#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "common/stream/character.h"

/// The course of a track: where its surface lies, apart from how it is painted.
namespace footing::scene {

inline constexpr std::size_t kMostSegments = 2000;  ///< More are not drawn.
inline constexpr float kPitDepthM = 0.6f;

/// How far a segment's edges run back or on, per metre to the left of the centre line: where the
/// track turns, both segments end on the line that halves the turn.
struct Mitre {
  double start = 0;  ///< Along offset of the start, over sideways.
  double end = 0;    ///< The same of the end, which runs on.
};

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

/// Between these lengths along the track it fades away; both 0: it does not.
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

}  // namespace footing::scene
