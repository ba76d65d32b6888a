#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"

namespace footing::sphere {

/// How a camera's bytes are laid out, by V4L2's names.
enum class PixelFormat {
  kSgrbg8,  ///< One byte a pixel: rows G R G R..., B G B G...
  kYuyv,    ///< Two bytes a pixel: luma of each, chroma of every two (BT.601, full range).
};

/// Bytes of one pixel in a row.
inline int BytesPerPixel(PixelFormat format) { return format == PixelFormat::kYuyv ? 2 : 1; }

/// A frame, borrowed; rows follow one another without padding. Pixel (0, 0) is the upper left one,
/// and its middle the origin of coordinates.
struct Image {
  PixelFormat format = PixelFormat::kSgrbg8;
  int width = 0, height = 0;  ///< Even.
  std::span<const std::uint8_t> bytes;

  const std::uint8_t* Row(int v) const {
    return bytes.data() +
           static_cast<std::size_t>(v) * static_cast<std::size_t>(width * BytesPerPixel(format));
  }
  /// Value of a pixel that is fitted: its colour's of a mosaic, luma of YUYV.
  int Value(int u, int v) const { return Row(v)[u * BytesPerPixel(format)]; }
  /// Which colour that is: red 0, green 1, blue 2; luma is 0.
  int Channel(int u, int v) const {
    if (format == PixelFormat::kYuyv) return 0;
    return (u + v) % 2 == 0 ? 1 : v % 2 == 0 ? 0 : 2;
  }
};

/// Mean of frames of one size and format, so that noise falls with their number.
class MeanImage {
 public:
  void Add(const Image& image);
  int count() const { return count_; }
  void Clear() { count_ = 0; }
  /// Rounded; borrowed until the next call. Of at least one frame.
  Image View();

 private:
  Image like_;
  int count_ = 0;
  std::vector<std::uint32_t> sums_;
  std::vector<std::uint8_t> bytes_;
};

/// A sphere as the switching of its light shows it.
struct Blink {
  Eigen::Vector2d centre_px{0, 0};
  double radius_px = 0;
  Eigen::Vector3d colour_dn{0, 0, 0};  ///< Red, green and blue of its middle while it is lit.
  double clipped_share = 0;            ///< Share of its middle's pixels: at the sensor's limit.
};

/// Spot that is brighter in `lit` than in `dark`: round, only one, not darker than 20 DN.
/// InvalidData says what else was there and what to do.
Result<Blink> FindBlink(const Image& dark, const Image& lit);

}  // namespace footing::sphere
