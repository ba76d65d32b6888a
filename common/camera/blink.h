#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/base/result.h"
#include "common/camera/image.h"

namespace footing::sphere {

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
  double clipped_share = 0;            ///< Of its middle's pixels: at the sensor's limit.
};

/// What is brighter in `lit` than in `dark`: one round spot, not darker than 20 DN. InvalidData
/// says what else was there and what to do.
Result<Blink> FindBlink(const Image& dark, const Image& lit);

}  // namespace footing::sphere
