#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "common/camera/cone.h"
#include "common/camera/edges.h"
#include "common/camera/image.h"
#include "common/camera/lit_quads.h"
#include "common/camera/local_slopes.h"
#include "common/camera/profile_table.h"
#include "common/camera/settings.h"

namespace footing::sphere {

inline constexpr int kSectors = kEdgeRays;
using SectorReach = std::array<double, kSectors>;

/// Number of the sector in which a direction lies, the first one around +u, then towards +v.
int SectorOf(const Eigen::Vector2d& from);

/// What is known of a sphere before the fit.
struct DiscStart {
  Contrast contrast;
  Eigen::Vector2d middle_px{0, 0};  ///< Of its blob: the origin of the slopes.
  Cone cone;
  /// Of each sector, seen from the cone's axis, the slope up to which the sphere is seen; infinite
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
  /// Of axis s, axis t and tangent; includes blur and limb within their deviations, and motion.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double blur_px = 0, limb = 0;
  Eigen::Vector2d motion_px{0, 0};  ///< Travel in the image during the exposure.
  double misfit = 0;                ///< Mean square residual over its expectation.
  double residual_share = 0;        ///< RMS residual over the contrast, weighted as the fit is.
  double used_share = 0;            ///< Of the sectors.
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

}  // namespace footing::sphere
