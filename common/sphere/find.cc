#include "common/sphere/find.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/sphere/cone.h"
#include "common/sphere/edges.h"

namespace footing::sphere {

/// A blob whose edge is a cone's.
struct Finder::Candidate {
  Contrast contrast;
  LocalSlopes slopes;
  Eigen::Vector2d middle_px;
  Cone cone;
  SectorReach reach;
  double quality = 0;  ///< Share of the edge times brightness.
};

namespace {

constexpr std::size_t kMostBlobs = 6;
constexpr std::size_t kMostFits = 3;
constexpr double kLowShare = 0.25, kHighShare = 0.55;  // Of the colour's own chroma.
constexpr double kGoodQuality = 0.7;
constexpr double kClearQuality = 0.88;  // Nothing else in sight is as bright and as round.
constexpr double kLeastQuality = 0.25;
constexpr double kLeastSeenShare = 0.2;
constexpr double kMostResidualShare = 0.2;
constexpr double kSaturatedShare = 0.02;

/// How much a blob is like a sphere of this colour, at a glance.
double Likeness(const Blob& blob, double chroma) {
  const int width = blob.right - blob.left + 1, height = blob.bottom - blob.top + 1;
  const double fill = blob.area / (0.25 * std::numbers::pi * width * height);
  const double aspect = static_cast<double>(std::min(width, height)) / std::max(width, height);
  const double strength = blob.score / (blob.area * chroma);
  return std::min(1.0, fill) * std::min(1.0, 1.5 * aspect) * std::min(1.0, strength);
}

/// Light of the sphere over what its colour says, at most 1.
double Brightness(const Contrast& contrast, const Target& target, PixelFormat format) {
  double light = 0, expected = 0;
  if (format == PixelFormat::kYuyv) {
    light = contrast.Height(0);
    expected = target.colour_dn.dot(Eigen::Vector3d(0.299, 0.587, 0.114));
  } else {
    for (int i = 0; i < 3; ++i) light += contrast.Height(i) * target.colour_dn[i];
    expected = target.colour_dn.squaredNorm();
  }
  return std::clamp(light / expected, 0.0, 1.0);
}

/// Which sectors have the cone's edge, and up to where the others show the sphere.
SectorReach ReachOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes) {
  constexpr double kNear = 1.6 * 2 * std::numbers::pi / kSectors;
  SectorReach reach;
  for (std::size_t s = 0; s < kSectors; ++s) {
    const double middle = 2 * std::numbers::pi * static_cast<double>(s) / kSectors;
    double nearest = fit.cone.tangent;
    int outliers = 0, inliers = 0;
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const Eigen::Vector2d from = slopes[i] - fit.cone.axis;
      const double apart =
          std::remainder(std::atan2(from.y(), from.x()) - middle, 2 * std::numbers::pi);
      if (std::abs(apart) > kNear) continue;
      ++(fit.inliers[i] ? inliers : outliers);
      if (!fit.inliers[i]) nearest = std::min(nearest, from.norm());
    }
    if (inliers > outliers) {
      reach[s] = std::numeric_limits<double>::infinity();
    } else {
      reach[s] = outliers > 0 ? nearest : 0;
    }
  }
  return reach;
}

Estimate ToEstimate(const DiscFit& fit, const LocalSlopes& slopes, double radius_m,
                    const Lens& lens) {
  const double t = fit.cone.tangent, secant = std::sqrt(1 + t * t);
  const double range_m = radius_m * secant / t;
  const Eigen::Vector3d along =
      slopes.R_CL() * Eigen::Vector3d(fit.cone.axis.x(), fit.cone.axis.y(), 1).normalized();
  Estimate estimate;
  estimate.p_C_m = range_m * along;
  Eigen::Matrix3d jacobian;
  jacobian.col(0) = range_m * slopes.R_CL().col(0);
  jacobian.col(1) = range_m * slopes.R_CL().col(1);
  jacobian.col(2) = -radius_m / (t * t * secant) * along;
  estimate.covariance_m2 = jacobian * fit.covariance * jacobian.transpose();
  estimate.centre_px = ToPixel(lens, along.head<2>() / along.z());
  estimate.radius_px = t / std::sqrt(slopes.scale().determinant());
  estimate.seen_share = fit.used_share;
  estimate.misfit = fit.misfit;
  estimate.residual_share = fit.residual_share;
  estimate.blur_px = fit.blur_px;
  estimate.limb = fit.limb;
  estimate.is_saturated = fit.clipped_share > kSaturatedShare;
  estimate.is_occluded = fit.used_share < 0.9;
  const auto falling = [](double value, double from, double to) {
    return std::clamp((to - value) / (to - from), 0.0, 1.0);
  };
  estimate.confidence = falling(-fit.used_share, -0.7, -0.2) *
                        falling(fit.residual_share, 0.06, kMostResidualShare) *
                        (estimate.is_saturated ? 0.3 : 1.0);
  return estimate;
}

}  // namespace

Finder::Finder(const Lens& lens, std::vector<Target> targets, const Settings& settings)
    : lens_(lens), targets_(std::move(targets)), settings_(settings) {}

std::vector<Finder::Candidate> Finder::Candidates(const Image& image, const Target& target,
                                                  double share) {
  const Eigen::Vector3d chroma = target.colour_dn.array() - target.colour_dn.mean();
  std::vector<Blob> blobs = FindBlobs(quads_, target.colour_dn, share);
  std::erase_if(blobs, [&](const Blob& blob) {
    return Likeness(blob, chroma.norm()) < 0.1 ||
           std::max(blob.right - blob.left, blob.bottom - blob.top) > quads_.height / 2;
  });
  std::sort(blobs.begin(), blobs.end(), [&](const Blob& a, const Blob& b) {
    return Likeness(a, chroma.norm()) > Likeness(b, chroma.norm());
  });
  if (blobs.size() > kMostBlobs) blobs.resize(kMostBlobs);
  std::vector<Candidate> candidates;
  for (const Blob& blob : blobs) {
    const auto edges = FindEdges(image, quads_, blob, settings_.noise);
    if (!edges) continue;
    const Eigen::Vector2d middle_px = 2 * blob.centre + Eigen::Vector2d(0.5, 0.5);
    const double size_px = 2.0 * std::max(blob.right - blob.left, blob.bottom - blob.top) + 2;
    LocalSlopes slopes(lens_, middle_px, size_px + 8);
    std::vector<Eigen::Vector2d> at;
    for (const Eigen::Vector2d& pixel : edges->pixels)
      at.push_back(slopes.At(pixel.x(), pixel.y()));
    const double per_px = std::sqrt(slopes.scale().determinant());
    const double tolerance = per_px * std::max(0.5, 0.04 * size_px);
    const auto fit = FitConeRobustly(at, tolerance, 0.8 * per_px, 1.5 * size_px * per_px);
    if (!fit) continue;
    Candidate candidate{edges->contrast, slopes, middle_px, fit->cone, ReachOf(*fit, at), 0};
    const auto inliers = std::count(fit->inliers.begin(), fit->inliers.end(), true);
    candidate.quality = static_cast<double>(inliers) / kEdgeRays *
                        Brightness(edges->contrast, target, image.format);
    candidates.push_back(candidate);
    if (candidate.quality > kClearQuality) break;
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.quality > b.quality; });
  return candidates;
}

std::optional<Estimate> Finder::Measure(const Image& image, const Target& target,
                                        const Candidate& candidate) const {
  const auto fit = FitDisc(image, candidate.slopes, candidate.cone, candidate.contrast,
                           candidate.reach, candidate.middle_px, settings_, table_);
  if (!fit || fit->used_share < kLeastSeenShare || fit->residual_share > kMostResidualShare)
    return std::nullopt;
  return ToEstimate(*fit, candidate.slopes, target.radius_m, lens_);
}

std::optional<Estimate> Finder::FindOne(const Image& image, const Target& target) {
  std::vector<Candidate> candidates = Candidates(image, target, kLowShare);
  if (candidates.empty() || candidates.front().quality < kGoodQuality) {
    for (Candidate& candidate : Candidates(image, target, kHighShare))
      candidates.push_back(candidate);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.quality > b.quality; });
  }
  for (std::size_t i = 0; i < std::min(kMostFits, candidates.size()); ++i) {
    if (candidates[i].quality < kLeastQuality) break;
    if (const auto estimate = Measure(image, target, candidates[i])) return estimate;
  }
  return std::nullopt;
}

std::vector<std::optional<Estimate>> Finder::Find(const Image& image) {
  ToQuads(image, quads_);
  std::vector<std::optional<Estimate>> found;
  for (const Target& target : targets_) found.push_back(FindOne(image, target));
  return found;
}

std::optional<Profile> Calibrate(const std::vector<Estimate>& estimates) {
  if (estimates.size() < 8) return std::nullopt;
  Profile profile;
  profile.blur_px = profile.limb = 0;
  for (const Estimate& estimate : estimates) {
    profile.blur_px += estimate.blur_px / static_cast<double>(estimates.size());
    profile.limb += estimate.limb / static_cast<double>(estimates.size());
  }
  return profile;
}

}  // namespace footing::sphere
