#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/camera/image.h"

namespace footing::sphere {

/// Red, green and blue of every 2 x 2 pixels, one plane each: a mosaic has all colours in that.
struct Quads {
  int width = 0, height = 0;
  std::vector<std::int16_t> red, green, blue;

  std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  /// The least of its three colours, DN: how white it is.
  int LeastAt(int x, int y) const {
    const std::size_t at = At(x, y);
    return std::min({red[at], green[at], blue[at]});
  }
};

/// A rectangle of quads; all four edges are included.
struct QuadWindow {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Window of a whole image.
QuadWindow Whole(const Image& image);

/// Fills a window of `quads`, whose memory is used again; what is outside of it is undefined.
void ToQuads(const Image& image, const QuadWindow& window, Quads& quads);
inline void ToQuads(const Image& image, Quads& quads) { ToQuads(image, Whole(image), quads); }

/// Connected quads of a hue; coordinates in quads.
struct Blob {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Included.
  int area = 0;
  double score = 0;              ///< Sum of the chroma along the hue, DN.
  Eigen::Vector2d centre{0, 0};  ///< Mean, weighted by the score.

  /// In pixels.
  Eigen::Vector2d MiddlePx() const { return 2 * centre + Eigen::Vector2d(0.5, 0.5); }
  double SizePx() const { return 2.0 * std::max(right - left, bottom - top) + 2; }
};

/// A blob with a margin around it, two quads and a share of its size; cut at the image's edges.
QuadWindow Around(const Blob& blob, const Quads& quads, double margin_share);

/// Quads whose chroma lies within 30 degrees of the colour's hue and reaches `share` of the
/// colour's own along it; white and grey have no chroma. Blobs of at least `kLeastQuads` within the
/// window.
std::vector<Blob> FindBlobs(const Quads& quads, const QuadWindow& window,
                            const Eigen::Vector3d& colour_dn, double share);

/// Quads whose colour is the sphere's own: its hue within 15 degrees or so, and its brightness.
/// They set a sphere apart from a duller thing of nearly its hue that touches it.
std::vector<Blob> FindBlobsOfColour(const Quads& quads, const QuadWindow& window,
                                    const Eigen::Vector3d& colour_dn);

inline constexpr int kLeastQuads = 2;

}  // namespace footing::sphere
