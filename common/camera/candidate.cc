#include "common/camera/candidate.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/camera/cone.h"
#include "common/camera/edge_fit.h"

namespace footing::sphere {
namespace {

constexpr double kUnlikelyColourOff = 0.3;  // Its confidence is 0.6 at most.
// Before a lamp the half level is that of the clipped light, so that the sphere seems smaller: by
// 0.2 blurs before a lamp at 1.2 times the sensor's limit, by 1.6 at 8 times.
constexpr double kLampBlurs = 0.9, kLampBlursSd = 0.5;

}  // namespace

double Likeness(const Blob& blob, const Eigen::Vector3d& colour_dn) {
  const double chroma = (colour_dn.array() - colour_dn.mean()).matrix().norm();
  const int width = blob.right - blob.left + 1, height = blob.bottom - blob.top + 1;
  const double fill = blob.area / (0.25 * std::numbers::pi * width * height);
  const double aspect = static_cast<double>(std::min(width, height)) / std::max(width, height);
  const double strength = blob.score / (blob.area * chroma);
  return std::min(1.0, fill) * std::min(1.0, 1.5 * aspect) * std::min(1.0, strength);
}

double ColourOff(const Eigen::Vector3d& seen_dn, const Eigen::Vector3d& colour_dn) {
  const double scale = seen_dn.dot(colour_dn) / colour_dn.squaredNorm();
  if (!(scale > 0)) return 1;
  const double hue = (seen_dn / scale - colour_dn).norm() / colour_dn.norm();
  return std::hypot(hue, std::max(0.0, 1 - scale));
}

std::optional<Candidate> CandidateOf(const Scene& scene, const Target& target, const Blob& blob,
                                     Surroundings around) {
  const InnerQuads inner = InnerQuadsOf(blob);
  const double colour_off = ColourOff(ColourOf(scene.quads, inner), target.colour_dn);
  if (colour_off >= kMostColourOff) return std::nullopt;  // Its confidence would be zero.
  const auto edges = FindEdges(scene.image, scene.quads, blob, inner, scene.settings.noise, around);
  if (!edges) return std::nullopt;
  const Eigen::Vector2d middle_px = blob.MiddlePx();
  const double size_px = blob.SizePx(), blur_px = scene.settings.profile.blur_px;
  // Its nodes lie near the edge, where an error would be one of the distance.
  LocalSlopes slopes(scene.lens, middle_px, 0.5 * size_px);
  std::vector<Eigen::Vector2d> at;
  for (std::size_t i = 0; i < edges->pixels.size(); ++i) {
    Eigen::Vector2d pixel = edges->pixels[i];
    if (edges->at_lamp[i]) pixel += kLampBlurs * blur_px * (pixel - middle_px).normalized();
    at.push_back(slopes.At(pixel.x(), pixel.y()));
  }
  const double per_px = std::sqrt(slopes.scale().determinant());
  const double tolerance = per_px * std::max(0.5, 0.04 * size_px);
  auto fit = FitConeRobustly(at, tolerance, 0.8 * per_px, 1.5 * size_px * per_px);
  if (!fit) return std::nullopt;
  const std::vector<bool> inliers = fit->inliers;
  int count = 0, at_lamp = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!inliers[i]) continue;
    ++count;
    if (!edges->at_lamp[i]) continue;
    ++at_lamp;
    fit->inliers[i] = false;  // The light there is the lamp's, too.
  }
  Candidate candidate{
      slopes,
      {edges->contrast, middle_px, fit->cone, ReachOf(*fit, at), at, target.radius_m},
      inliers};
  if (around == Surroundings::kLamp) candidate.start.lit = LitQuads(scene.quads, blob);
  candidate.colour_off = colour_off;
  candidate.is_compact = size_px < 3 * fit->cone.tangent / per_px + 4;
  candidate.start.is_unlikely = colour_off > kUnlikelyColourOff;
  candidate.quality =
      static_cast<double>(count) / kEdgeRays * std::max(0.0, 1 - candidate.colour_off);
  candidate.radius_sd_px = kLampBlursSd * blur_px * at_lamp / std::max(1, count);
  return candidate;
}

}  // namespace footing::sphere
