#pragma once

#include <vector>

#include "common/camera/blobs.h"

namespace footing::sphere {

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
