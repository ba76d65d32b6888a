#include "common/camera/find.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/camera/disc_fit.h"
#include "common/camera/edges.h"

namespace footing::sphere {

namespace {

constexpr std::size_t kMostBlobs = 6;
constexpr std::size_t kMostFits = 3;
constexpr double kLowShare = 0.25;  // Share of the colour's own chroma.
constexpr double kGoodQuality = 0.7;
constexpr double kClearQuality = 0.88;  // Nothing else in sight is as bright and as round.
constexpr double kLeastQuality = 0.25, kLeastQualityByEdge = 0.45;
constexpr double kConfidenceByEdge = 0.2;
// Beside a lamp: of a blob's size against the disc's, a quad and a blur on either side; of the
// distance, over it.
constexpr double kMostOffPx = 6, kMostSdShare = 0.25;
constexpr double kLeastSeenShare = 0.2;
constexpr double kMostResidualShare = 0.2;
constexpr double kSaturatedShare = 0.02;
// Near the last place: 2 m/s at 1 m and 60 Hz is 18 px a frame, of which most is foreseen.
constexpr double kNearMarginPx = 24;
constexpr double kTrustedConfidence = 0.5;
constexpr int kMostNearFrames = 300;  // A better place elsewhere is seen within 5 s.

/// A square in the image, in quads; empty (right < left) when it is outside.
QuadWindow Square(const Eigen::Vector2d& middle_px, double half_px, const QuadWindow& whole) {
  const auto quad = [](double px) { return static_cast<int>(std::floor(px / 2)); };
  return {std::max(whole.left, quad(middle_px.x() - half_px)),
          std::max(whole.top, quad(middle_px.y() - half_px)),
          std::min(whole.right, quad(middle_px.x() + half_px)),
          std::min(whole.bottom, quad(middle_px.y() + half_px))};
}

/// Cut off by a window that does not end where the image does.
bool IsCut(const Blob& blob, const QuadWindow& window, const QuadWindow& whole) {
  return (blob.left == window.left && window.left > whole.left) ||
         (blob.top == window.top && window.top > whole.top) ||
         (blob.right == window.right && window.right < whole.right) ||
         (blob.bottom == window.bottom && window.bottom < whole.bottom);
}

Estimate ToEstimate(const DiscFit& fit, const LocalSlopes& slopes, double radius_m,
                    double colour_off, const Lens& lens) {
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
  estimate.colour_off = colour_off;
  estimate.blur_px = fit.blur_px;
  estimate.limb = fit.limb;
  estimate.motion_px = fit.motion_px;
  estimate.is_saturated = fit.clipped_share > kSaturatedShare;
  estimate.is_occluded = fit.used_share < 0.9;
  const auto falling = [](double value, double from, double to) {
    return std::clamp((to - value) / (to - from), 0.0, 1.0);
  };
  estimate.confidence = falling(-fit.used_share, -0.7, -0.2) *
                        falling(fit.residual_share, 0.06, kMostResidualShare) *
                        falling(colour_off, kSureColourOff, kMostColourOff) *
                        (estimate.is_saturated ? 0.3 : 1.0) * (fit.is_doubtful ? 0.5 : 1.0);
  return estimate;
}

/// Standard deviation of the distance, as a share of it.
double DepthSdShare(const Estimate& estimate) {
  const Eigen::Vector3d along = estimate.p_C_m.normalized();
  return std::sqrt(along.dot(estimate.covariance_m2 * along)) / estimate.p_C_m.norm();
}

}  // namespace

Finder::Finder(const Lens& lens, std::vector<Target> targets, const Settings& settings)
    : lens_(lens),
      targets_(std::move(targets)),
      settings_(settings),
      last_(targets_.size()),
      left_out_(targets_.size()) {}

bool Finder::IsLeftOut(const Blob& blob, std::size_t sphere) const {
  const Eigen::Vector2d middle_px = blob.MiddlePx();
  const auto& places = left_out_[sphere];
  return std::any_of(places.begin(), places.end(), [&](const Circle& place) {
    return (middle_px - place.centre_px).norm() < place.radius_px;
  });
}

/// Those that may be a sphere, the likeliest first.
std::vector<Blob> Finder::Likely(std::vector<Blob> blobs, std::size_t sphere,
                                 const QuadWindow& window, const QuadWindow& whole) const {
  const Eigen::Vector3d& colour_dn = targets_[sphere].colour_dn;
  std::erase_if(blobs, [&](const Blob& blob) {
    return IsCut(blob, window, whole) || IsLeftOut(blob, sphere) ||
           Likeness(blob, colour_dn) < 0.1 ||
           std::max(blob.right - blob.left, blob.bottom - blob.top) > quads_.height / 2;
  });
  std::sort(blobs.begin(), blobs.end(), [&](const Blob& a, const Blob& b) {
    return Likeness(a, colour_dn) > Likeness(b, colour_dn);
  });
  if (blobs.size() > kMostBlobs) blobs.resize(kMostBlobs);
  return blobs;
}

std::vector<Candidate> Finder::Candidates(const Image& image, std::size_t sphere,
                                          const std::vector<Blob>& blobs) const {
  std::vector<Candidate> candidates;
  for (const Blob& blob : blobs) {
    const auto candidate =
        CandidateOf({image, quads_, lens_, settings_}, targets_[sphere], blob, Surroundings::kAny);
    if (!candidate) continue;
    candidates.push_back(*candidate);
    if (candidate->quality > kClearQuality) break;
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.quality > b.quality; });
  return candidates;
}

std::optional<Estimate> Finder::Measure(const Image& image, const Target& target,
                                        const Candidate& candidate) const {
  const auto fit = FitDisc(image, candidate.slopes, candidate.start, settings_, table_);
  if (!fit || fit->used_share < kLeastSeenShare || fit->residual_share > kMostResidualShare)
    return std::nullopt;
  return ToEstimate(*fit, candidate.slopes, target.radius_m, candidate.colour_off, lens_);
}

std::optional<Finder::Found> Finder::Search(const Image& image, std::size_t sphere,
                                            const QuadWindow& window,
                                            const std::optional<Eigen::Vector2d>& motion_px) {
  const Target& target = targets_[sphere];
  const Eigen::Vector3d& colour_dn = target.colour_dn;
  const QuadWindow whole = Whole(image);
  std::vector<Blob> blobs =
      Likely(FindBlobs(quads_, window, colour_dn, kLowShare), sphere, window, whole);
  std::vector<Candidate> candidates = Candidates(image, sphere, blobs);
  if (candidates.empty() || candidates.front().quality < kGoodQuality) {
    const std::vector<Blob> own =
        Likely(FindBlobsOfColour(quads_, window, colour_dn), sphere, window, whole);
    for (Candidate& candidate : Candidates(image, sphere, own)) candidates.push_back(candidate);
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.quality > b.quality; });
    blobs.insert(blobs.end(), own.begin(), own.end());
  }
  std::optional<Found> found;
  for (std::size_t i = 0; i < std::min(kMostFits, candidates.size()) && !found; ++i) {
    if (candidates[i].quality < kLeastQuality) break;
    candidates[i].start.motion_px = motion_px;
    if (const auto estimate = Measure(image, target, candidates[i]))
      found = Found{*estimate, candidates[i].quality};
  }
  if (!found && !candidates.empty()) found = ByEdge(target, candidates.front());
  if (found && found->estimate.confidence > kConfidenceByEdge) return found;
  const auto beside_lamp = BesideLamp(image, target, blobs);
  return beside_lamp ? beside_lamp : found;
}

/// Estimate from a light that is certainly the sphere's by colour and edge.
std::optional<Finder::Found> Finder::ByEdge(const Target& target,
                                            const Candidate& candidate) const {
  if (candidate.quality < kLeastQualityByEdge || candidate.colour_off > kSureColourOff ||
      !candidate.is_compact)
    return std::nullopt;
  const auto fit =
      FitEdge(candidate.slopes, candidate.start, candidate.inliers, candidate.radius_sd_px);
  if (!fit) return std::nullopt;
  Estimate estimate =
      ToEstimate(*fit, candidate.slopes, target.radius_m, candidate.colour_off, lens_);
  estimate.is_by_edge = true;
  estimate.confidence = kConfidenceByEdge * fit->used_share;
  return Found{estimate, candidate.quality};
}

/// Estimate from a light that touches a lamp, without what the lamp lights or by its edge, as is
/// surer. Its size must be that of its blob. It is as doubtful as one by its edge alone.
std::optional<Finder::Found> Finder::BesideLamp(const Image& image, const Target& target,
                                                const std::vector<Blob>& blobs) const {
  for (const Blob& blob : blobs) {
    const Eigen::Vector3d seen_dn = ColourOf(quads_, InnerQuadsOf(blob));
    if (ColourOff(seen_dn, target.colour_dn) > kSureColourOff || !LitQuads(quads_, blob).Any())
      continue;
    const auto candidate =
        CandidateOf({image, quads_, lens_, settings_}, target, blob, Surroundings::kLamp);
    if (!candidate || candidate->quality < kLeastQuality) continue;
    const auto fits = [&](const std::optional<Found>& found) {
      return found && std::abs(blob.SizePx() - 2 * found->estimate.radius_px) < kMostOffPx &&
             DepthSdShare(found->estimate) < kMostSdShare;
    };
    std::optional<Found> found = ByEdge(target, *candidate);
    const auto estimate = Measure(image, target, *candidate);
    const auto measured =
        estimate ? std::optional<Found>({*estimate, candidate->quality}) : std::optional<Found>();
    const bool is_surer = fits(measured) && (!fits(found) || DepthSdShare(measured->estimate) <
                                                                 DepthSdShare(found->estimate));
    if (is_surer) found = measured;
    if (!fits(found)) continue;
    found->estimate.confidence = std::min(found->estimate.confidence, kConfidenceByEdge);
    return found;
  }
  return std::nullopt;
}

/// Where it should be now; nothing unless it is clearly there.
std::optional<Finder::Found> Finder::Near(const Image& image, std::size_t sphere) {
  std::optional<Last>& last = last_[sphere];
  if (!last || ++last->near_frames > kMostNearFrames) return std::nullopt;
  const QuadWindow whole = Whole(image);
  const Eigen::Vector2d middle_px = last->centre_px + last->step_px;
  const double half_px = 1.5 * last->radius_px + kNearMarginPx + 0.5 * last->step_px.norm();
  const QuadWindow window = Square(middle_px, half_px, whole);
  if (window.right < window.left || window.bottom < window.top) return std::nullopt;
  // Edges are looked for beyond a blob, by 0.6 of its size and two quads.
  if (!has_whole_) ToQuads(image, Square(middle_px, 2.3 * half_px + 6, whole), quads_);
  const Shutter& shutter = settings_.shutter;
  const Eigen::Vector2d motion_px = shutter.exposure_s / shutter.period_s * last->step_px;
  const auto found = Search(image, sphere, window, motion_px);
  const bool is_clear =
      found && found->quality > kGoodQuality && found->estimate.confidence > kTrustedConfidence;
  return is_clear ? found : std::nullopt;
}

std::optional<Estimate> Finder::FindOne(const Image& image, std::size_t sphere) {
  std::optional<Found> found = Near(image, sphere);
  const bool is_near = found.has_value();
  if (!is_near) {
    if (!has_whole_) ToQuads(image, quads_);
    has_whole_ = true;
    found = Search(image, sphere, Whole(image), std::nullopt);
  }
  std::optional<Last>& last = last_[sphere];
  if (!found || found->estimate.confidence < kTrustedConfidence) {
    last.reset();
  } else {
    const Estimate& estimate = found->estimate;
    Last next{estimate.centre_px, {0, 0}, estimate.radius_px, is_near ? last->near_frames : 0};
    if (is_near) next.step_px = estimate.centre_px - last->centre_px;
    last = next;
  }
  return found ? std::optional<Estimate>(found->estimate) : std::nullopt;
}

std::vector<std::optional<Estimate>> Finder::Find(const Image& image) {
  has_whole_ = false;
  std::vector<std::optional<Estimate>> found;
  for (std::size_t i = 0; i < targets_.size(); ++i) found.push_back(FindOne(image, i));
  return found;
}

std::optional<Profile> Calibrate(const std::vector<Estimate>& estimates) {
  Profile profile;
  profile.blur_px = profile.limb = 0;
  int count = 0;
  for (const Estimate& estimate : estimates) {
    if (estimate.is_by_edge) continue;
    profile.blur_px += estimate.blur_px;
    profile.limb += estimate.limb;
    ++count;
  }
  if (count < 8) return std::nullopt;
  profile.blur_px /= count;
  profile.limb /= count;
  return profile;
}

}  // namespace footing::sphere
