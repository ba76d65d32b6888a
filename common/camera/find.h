#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "common/camera/blobs.h"
#include "common/camera/disc_fit.h"
#include "common/camera/edges.h"
#include "common/camera/image.h"
#include "common/camera/lens.h"

namespace footing::sphere {

/// Where a sphere is.
struct Estimate {
  Eigen::Vector3d p_C_m{0, 0, 0};  ///< Its centre, camera frame.
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();
  double confidence = 0;            ///< 0 to 1: how sure it is that this is the sphere, seen well.
  Eigen::Vector2d centre_px{0, 0};  ///< Where its centre appears.
  double radius_px = 0;             ///< Radius of its disc.
  bool is_saturated = false;        ///< Light at the sensor's limit: depth is wrong by centimetres.
  bool is_occluded = false;         ///< Part of the edge is hidden, or beyond the image.
  bool is_by_edge = false;          ///< No fit explains its light: its edge alone says where it is.
  double seen_share = 0;            ///< Share of its edge that is seen.
  double misfit = 0;                ///< Mean square residual over the noise; about 1.
  double residual_share = 0;        ///< RMS residual over the contrast.
  double colour_off = 0;            ///< Its colour's distance from the target's, over its length.
  double blur_px = 0, limb = 0;     ///< As fitted, for `Calibrate`.
  Eigen::Vector2d motion_px{0, 0};  ///< Travel during the exposure; zero if it seems to be at rest.
};

/// A place in the image.
struct Circle {
  Eigen::Vector2d centre_px{0, 0};
  double radius_px = 0;
};

/// Finds luminous spheres in a frame, each by its hue: chroma to find blobs, then the light itself
/// for edges, a robust cone and a photometric fit (docs/camera.md). Each is looked for where it
/// should be by the two frames before, and in the whole image when it is not clearly there. Frames
/// are those of one camera, in their order.
class Finder {
 public:
  Finder(const Lens& lens, std::vector<Target> targets, const Settings& settings);

  /// One for each target, in their order; nothing where it is not in sight.
  std::vector<std::optional<Estimate>> Find(const Image& image);
  /// The next frame is of another scene.
  void Forget() { last_.assign(targets_.size(), std::nullopt); }
  /// Places of other lights: blobs with their middle there are left out from now on.
  void LeaveOut(std::size_t sphere, std::vector<Circle> places) {
    left_out_[sphere] = std::move(places);
  }

 private:
  struct Found {
    Estimate estimate;
    double quality = 0;  ///< Quality of its candidate.
  };
  /// Where a sphere was.
  struct Last {
    Eigen::Vector2d centre_px{0, 0}, step_px{0, 0};
    double radius_px = 0;
    int near_frames = 0;  ///< Since the whole image was searched.
  };
  std::optional<Estimate> FindOne(const Image& image, std::size_t sphere);
  std::optional<Found> Near(const Image& image, std::size_t sphere);
  std::optional<Found> Search(const Image& image, std::size_t sphere, const QuadWindow& window,
                              const std::optional<Eigen::Vector2d>& motion_px);
  std::vector<Blob> Likely(std::vector<Blob> blobs, std::size_t sphere, const QuadWindow& window,
                           const QuadWindow& whole) const;
  std::vector<Candidate> Candidates(const Image& image, std::size_t sphere,
                                    const std::vector<Blob>& blobs) const;
  bool IsLeftOut(const Blob& blob, std::size_t sphere) const;
  std::optional<Found> ByEdge(const Target& target, const Candidate& candidate) const;
  std::optional<Found> BesideLamp(const Image& image, const Target& target,
                                  const std::vector<Blob>& blobs) const;
  std::optional<Estimate> Measure(const Image& image, const Target& target,
                                  const Candidate& candidate) const;

  Lens lens_;
  std::vector<Target> targets_;
  Settings settings_;
  ProfileTable table_;
  Quads quads_;
  bool has_whole_ = false;  ///< `quads_` are of the whole image.
  std::vector<std::optional<Last>> last_;
  std::vector<std::vector<Circle>> left_out_;
};

/// Blur and limb of a sphere through a camera, from estimates at 0.5 to 1.2 m that were made with
/// loose deviations (blur_sd_px 0.3, limb_sd 0.3): their means weighted alike. No truth is needed.
/// Nothing from fewer than eight estimates.
std::optional<Profile> Calibrate(const std::vector<Estimate>& estimates);

}  // namespace footing::sphere
