#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/sphere/blobs.h"
#include "common/sphere/image.h"

namespace footing::sphere {

/// Where a light at the sensor's limit, as a lamp behind a sphere, brightens an image. What lies
/// beyond the limit is unknown, and so is what the blur carries from there to its neighbours.
class Glare {
 public:
  /// Looks at the quads of a window. A channel counts whose level `inside` the sphere is below
  /// kBrightDn; `reach_px` is how far such a pixel's light goes.
  void Find(const Image& image, const QuadWindow& window, const std::array<double, 3>& inside,
            double reach_px);
  /// Whether it reaches a quad of the window.
  bool Reaches(int x, int y) const {
    return is_any_ && bright_[static_cast<std::size_t>((y - window_.top) * width_) +
                              static_cast<std::size_t>(x - window_.left)] != 0;
  }

 private:
  void Mark(int x, int y, double reach_quads);

  QuadWindow window_;
  int width_ = 0;
  bool is_any_ = false;
  std::vector<std::uint8_t> bright_;
};

}  // namespace footing::sphere
