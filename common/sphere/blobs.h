#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/sphere/image.h"

namespace footing::sphere {

/// Red, green and blue of every 2 x 2 pixels, one plane each: a mosaic has all colours in that.
struct Quads {
  int width = 0, height = 0;
  std::vector<std::int16_t> red, green, blue;
};

/// A rectangle of quads; all four edges are included.
struct QuadWindow {
  int left = 0, top = 0, right = 0, bottom = 0;
};

/// Of a whole image.
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
};

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
