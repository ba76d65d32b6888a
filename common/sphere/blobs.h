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

/// Fills `quads`, whose memory is used again.
void ToQuads(const Image& image, Quads& quads);

/// Connected quads of a hue; coordinates in quads.
struct Blob {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Included.
  int area = 0;
  double score = 0;              ///< Sum of the chroma along the hue, DN.
  Eigen::Vector2d centre{0, 0};  ///< Mean, weighted by the score.
};

/// Quads whose chroma lies within 30 degrees of the colour's hue and reaches `share` of the
/// colour's own along it; white and grey have no chroma. Blobs of at least `kLeastQuads`.
std::vector<Blob> FindBlobs(const Quads& quads, const Eigen::Vector3d& colour_dn, double share);

inline constexpr int kLeastQuads = 2;

}  // namespace footing::sphere
