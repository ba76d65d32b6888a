#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "common/camera/blobs.h"
#include "common/camera/edges.h"
#include "common/camera/image.h"
#include "common/camera/lens.h"

namespace footing::sphere {

/// The cone of rays that touch a sphere, in slopes of a frame whose third axis is near the cone's:
/// a ray's coordinates are (s, t, 1).
struct Cone {
  Eigen::Vector2d axis{0, 0};  ///< Slopes of its axis.
  double tangent = 0;          ///< Tangent of its half angle.
};

/// A cone fitted to points on a silhouette.
struct ConeFit {
  Cone cone;
  std::vector<bool> inliers;  ///< Whether each point fits.
};

/// Least squares on unit rays u of the silhouette: u . w = 1 with w along the axis and |w| =
/// 1/cos of the half angle; linear, no ellipse. Nothing with fewer than three points or when they
/// lie on no cone.
std::optional<Cone> FitCone(const std::vector<Eigen::Vector2d>& slopes,
                            const std::vector<bool>& use);

/// The same by consensus: the cone through three points that has the most others within
/// `tolerance` of its edge, in slopes, fitted again to those. Its half angle's tangent is within
/// `narrowest` and `widest`.
std::optional<ConeFit> FitConeRobustly(const std::vector<Eigen::Vector2d>& slopes, double tolerance,
                                       double narrowest, double widest);

/// How far a ray is outside of the cone, in slopes.
double Beyond(const Cone& cone, const Eigen::Vector2d& slopes);

/// Slopes around a direction, as a function of the pixel: exact at nine pixels of a window, and
/// quadratic between them (below 0.002 px for a lens that bends 10 % at its corners).
class LocalSlopes {
 public:
  /// `middle` is the window's middle and the direction of the third axis, `half_px` its half size.
  LocalSlopes(const Lens& lens, const Eigen::Vector2d& middle, double half_px);

  Eigen::Vector2d At(double u, double v) const;
  /// d slopes / d pixel in the middle.
  const Eigen::Matrix2d& scale() const { return scale_; }
  /// How that changes, per pixel along u (0) or v (1).
  Eigen::Matrix2d ScaleChange(int axis) const;
  /// Columns: the axes of s and t and the third one, in C.
  const Eigen::Matrix3d& R_CL() const { return R_CL_; }

 private:
  Eigen::Vector2d middle_;
  double half_px_;
  Eigen::Matrix<double, 2, 9> terms_;  ///< Coefficients of 1, x, x², y, xy, x²y, y², xy², x²y².
  Eigen::Matrix2d scale_;
  Eigen::Matrix3d R_CL_;
};

/// Brightness of a blurred disc at a distance from its middle, and how it changes.
struct ProfileValue {
  float disc = 0;  ///< Light of an even disc: 1 inside, 0 outside.
  float limb = 0;  ///< Light of a disc whose brightness is 1 - cos, 0 in the middle, 1 at the edge.
  float disc_d = 0, limb_d = 0;        ///< Slopes along `beyond`.
  float disc_blur = 0, limb_blur = 0;  ///< Slopes along `blur`.
};

/// Both discs convolved with a Gaussian, tabulated once by numerical integration over radius, with
/// the angle done by a Bessel function. Distances are in units of the blur's deviation.
class ProfileTable {
 public:
  ProfileTable();

  /// `beyond`: distance outside of the edge, in blurs; `blur`: deviation over the disc's radius,
  /// held to 0.005 to 0.6.
  ProfileValue At(float beyond, float blur) const;

  static constexpr float kReach = 5;  ///< Beyond that, the disc is 1 or 0.

 private:
  static constexpr int kBlurs = 61, kDistances = 101;
  static constexpr float kLeastBlur = 0.005F, kBlurStep = 0.01F, kDistanceStep = 0.1F;

  struct Cell {
    float disc, limb;
  };
  std::vector<Cell> cells_;
};

inline constexpr int kSectors = kEdgeRays;
using SectorReach = std::array<double, kSectors>;

/// Number of the sector in which a direction lies, the first one around +u, then towards +v.
int SectorOf(const Eigen::Vector2d& from);

/// Knowledge of a sphere before the fit.
struct DiscStart {
  Contrast contrast;
  Eigen::Vector2d middle_px{0, 0};  ///< Middle of its blob: the origin of the slopes.
  Cone cone;
  /// For each sector, seen from the cone's axis, the slope up to which the sphere is seen; infinite
  /// where the cone's edge is.
  SectorReach reach{};
  std::vector<Eigen::Vector2d> edges;  ///< Slopes at which the light falls to the half.
  double radius_m = 0.0225;
  LitQuads lit = {};                              ///< They take no part.
  std::optional<Eigen::Vector2d> motion_px = {};  ///< During an exposure, by the frames before.
  /// Its colour is hardly the sphere's, so that its confidence will be low: it is measured from
  /// fewer pixels, and not as one that moves.
  bool is_unlikely = false;
};

/// The cone that explains the pixels best.
struct DiscFit {
  Cone cone;
  /// Covariance of axis s, axis t and tangent; includes blur and limb within their deviations, and
  /// motion.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double blur_px = 0, limb = 0;
  Eigen::Vector2d motion_px{0, 0};  ///< Travel in the image during the exposure.
  double misfit = 0;                ///< Mean square residual over its expectation.
  double residual_share = 0;        ///< RMS residual over the contrast, weighted as the fit is.
  double used_share = 0;            ///< Share of the sectors that the fit uses.
  /// Clutter looks so, too: partly hidden by an edge, or smaller than two blurs.
  bool is_doubtful = false;
  double clipped_share = 0;  ///< Pixels at the upper limit, of those inside.
};

/// Photometric fit: a blurred, limb-darkened disc with a brightness gradient over an even
/// background, each colour of the mosaic with two levels of its own. Levenberg-Marquardt on the
/// pixels as they are; the variance is the sensor's. Sectors whose surroundings do not fit (an
/// occluder, another lamp behind) are left out. Where the residuals say so, the sphere is fitted as
/// one that moves, or as one of which a straight edge hides a part.
std::optional<DiscFit> FitDisc(const Image& image, const LocalSlopes& slopes,
                               const DiscStart& start, const Settings& settings,
                               const ProfileTable& table);

/// Which sectors have the cone's edge, and up to where the others show the sphere.
SectorReach ReachOf(const ConeFit& fit, const std::vector<Eigen::Vector2d>& slopes);

/// A sphere whose light no photometric fit explains, as one before the edge of a lamp: its cone as
/// the edges give it, with a covariance that follows from them. Its direction is good to a
/// fraction of a pixel, its distance is rough. `inliers` are those of `start.edges`; `radius_sd_px`
/// is what they have in common beside the usual. Nothing when they are too few.
std::optional<DiscFit> FitEdge(const LocalSlopes& slopes, const DiscStart& start,
                               const std::vector<bool>& inliers, double radius_sd_px);

// Limb, gradient and the blur of the smallest spheres change the colour by 0.15.
inline constexpr double kSureColourOff = 0.2, kMostColourOff = 0.45;

/// A blob whose edge is a cone's.
struct Candidate {
  LocalSlopes slopes;
  DiscStart start;
  std::vector<bool> inliers;  ///< Whether each edge fits the cone.
  bool is_compact = false;    ///< Its blob does not extend far beyond the cone.
  double colour_off = 0;      ///< From the sphere's own.
  double quality = 0;         ///< Share of the edge, less for another colour.
  double radius_sd_px = 0;    ///< Standard deviation that its edges have in common, before a lamp.
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
