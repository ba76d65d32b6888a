#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "common/camera/blobs.h"
#include "common/camera/image.h"

namespace footing::sphere {

/// A luminous sphere that is looked for.
struct Target {
  /// Red, green and blue as the camera shows it at the locked exposure, DN. The hue decides which
  /// sphere is which; 30 degrees apart is enough.
  Eigen::Vector3d colour_dn{170, 40, 150};
  double radius_m = 0.0225;  ///< Radius of a PS Move.
};

/// How a small luminous sphere looks through this camera. Calibrated per controller and camera
/// (`Calibrate`), then held to these deviations.
struct Profile {
  double blur_px = 0.945;  ///< Standard deviation of lens and pixel together.
  double blur_sd_px = 0.02;
  double limb = 0.15;  ///< Brightness falls by limb (1 - cos) from the middle to the edge.
  double limb_sd = 0.02;
};

/// Variance of a pixel: read_dn² + dn_per_electron * value, 1/12 for rounding; times `correlation`
/// where neighbours are not independent (a demosaiced image).
struct PixelNoise {
  double read_dn = 1.5;
  double dn_per_electron = 0.03;
  double correlation = 1;

  /// Variance of a dark pixel whose neighbours are independent.
  double DarkVariance() const { return read_dn * read_dn + 1.0 / 12; }
};

/// When the rows of a frame see the light. A hand that moves blurs the sphere along its way, and a
/// rolling shutter stretches and slants it.
struct Shutter {
  double exposure_s = 0.004;
  double row_s = 0.0155 / 479;  ///< From one row to the next one.
  double period_s = 1.0 / 60;   ///< From one frame to the next one.
  double speed_sd_mps = 1;      ///< Standard deviation of an unknown hand's speed, along each axis.
};

/// Properties of a camera on which the finder depends.
struct Settings {
  Profile profile;
  PixelNoise noise;
  Shutter shutter;
};

/// Light of a sphere and of what is around it in each channel of the image, DN.
struct Contrast {
  std::array<double, 3> inside{}, outside{};
  double Height(int channel) const {
    return inside[static_cast<std::size_t>(channel)] - outside[static_cast<std::size_t>(channel)];
  }
};

inline constexpr int kEdgeRays = 32;

/// The middle of a blob, in at most some hundred quads; of a small one the middle quad.
using InnerQuads = std::vector<std::pair<int, int>>;
InnerQuads InnerQuadsOf(const Blob& blob);

/// Red, green and blue in the middle of a blob.
Eigen::Vector3d ColourOf(const Quads& quads, const InnerQuads& inner);

/// Where the light falls to the half between inside and outside along rays from a blob's middle.
struct Edges {
  Contrast contrast;
  std::vector<Eigen::Vector2d> pixels;  ///< Ends of the rays that meet an edge.
  std::vector<bool> at_lamp;            ///< Those of them that meet a lamp.
};

/// Surroundings of a blob.
enum class Surroundings {
  kAny,
  kLamp,  ///< In part: what is outside is the rest, and rays may end where white light begins.
};

/// Edges on the light itself, not on the chroma: each colour is set between its own levels inside
/// and outside and weighted by its contrast over its noise, so that a mosaic needs no
/// interpolation. Sub-pixel by linear interpolation. At a lamp, whose light clips, an edge is where
/// the least of the three colours rises to the half. Nothing when the blob has no contrast.
std::optional<Edges> FindEdges(const Image& image, const Quads& quads, const Blob& blob,
                               const InnerQuads& inner, const PixelNoise& noise,
                               Surroundings around = Surroundings::kAny);

/// In each colour: half of the sensor's range. A sphere has a hue, however bright it is.
inline constexpr int kWhiteDn = 128;

/// Quads around a blob that a lamp lights: white ones, and those that its blur reaches.
class LitQuads {
 public:
  LitQuads() = default;  ///< None.
  /// As far as a fit looks.
  LitQuads(const Quads& quads, const Blob& blob);

  bool Any() const { return any_; }
  bool At(int x, int y) const {
    return any_ && x >= window_.left && x <= window_.right && y >= window_.top &&
           y <= window_.bottom && lit_[Place(x, y)];
  }

 private:
  std::size_t Place(int x, int y) const {
    return static_cast<std::size_t>((y - window_.top) * (window_.right - window_.left + 1) + x -
                                    window_.left);
  }

  QuadWindow window_;
  std::vector<bool> lit_;
  bool any_ = false;
};

}  // namespace footing::sphere
