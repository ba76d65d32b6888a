#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "common/camera/blobs.h"
#include "common/camera/image.h"
#include "common/camera/settings.h"

namespace footing::sphere {

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
  std::vector<Eigen::Vector2d> pixels;  ///< Of the rays that meet an edge.
  std::vector<bool> at_lamp;            ///< Those of them that meet a lamp.
};

/// What is around a blob.
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

}  // namespace footing::sphere
