#pragma once

#include <optional>
#include <vector>

#include "common/camera/blobs.h"
#include "common/camera/disc_fit.h"
#include "common/camera/edges.h"
#include "common/camera/image.h"
#include "common/camera/lens.h"
#include "common/camera/local_slopes.h"
#include "common/camera/settings.h"

namespace footing::sphere {

// Limb, gradient and the blur of the smallest spheres change the colour by 0.15.
inline constexpr double kSureColourOff = 0.2, kMostColourOff = 0.45;

/// A blob whose edge is a cone's.
struct Candidate {
  LocalSlopes slopes;
  DiscStart start;
  std::vector<bool> inliers;  ///< Of its edges.
  bool is_compact = false;    ///< Its blob does not extend far beyond the cone.
  double colour_off = 0;      ///< From the sphere's own.
  double quality = 0;         ///< Share of the edge, less for another colour.
  double radius_sd_px = 0;    ///< What its edges have in common, before a lamp.
};

/// Where candidates are looked for.
struct Scene {
  const Image& image;
  const Quads& quads;
  const Lens& lens;
  const Settings& settings;
};

/// How much a blob is like a sphere of this colour, at a glance: by its shape and its chroma.
double Likeness(const Blob& blob, const Eigen::Vector3d& colour_dn);

/// How far a colour is from the sphere's: by hue and saturation, and by how much darker it is, over
/// its length. Brighter is allowed: it may be at the sensor's limit.
double ColourOff(const Eigen::Vector3d& seen_dn, const Eigen::Vector3d& colour_dn);

/// Nothing where the colour is another one, or the edge none of a cone. Beside a lamp only edges
/// that are not the lamp's and pixels that it does not light count for the fit of the light.
std::optional<Candidate> CandidateOf(const Scene& scene, const Target& target, const Blob& blob,
                                     Surroundings around);

}  // namespace footing::sphere
