#include "common/sphere/glare.h"

#include <algorithm>
#include <cmath>

#include "common/sphere/edges.h"

namespace footing::sphere {

void Glare::Find(const Image& image, const QuadWindow& window, const std::array<double, 3>& inside,
                 double reach_px) {
  window_ = window;
  width_ = window.right - window.left + 1;
  is_any_ = false;
  const auto is_clipped = [&](int u, int v) {
    return image.Value(u, v) >= kClippedDn &&
           inside[static_cast<std::size_t>(image.Channel(u, v))] < kBrightDn;
  };
  const double reach_quads = 0.5 * reach_px;
  const int beside = static_cast<int>(std::ceil(reach_quads));
  const QuadWindow whole = Whole(image);
  for (int y = std::max(0, window.top - beside);
       y <= std::min(whole.bottom, window.bottom + beside); ++y) {
    for (int x = std::max(0, window.left - beside);
         x <= std::min(whole.right, window.right + beside); ++x) {
      if (is_clipped(2 * x, 2 * y) || is_clipped(2 * x + 1, 2 * y) ||
          is_clipped(2 * x, 2 * y + 1) || is_clipped(2 * x + 1, 2 * y + 1))
        Mark(x, y, reach_quads);
    }
  }
}

void Glare::Mark(int x, int y, double reach_quads) {
  if (!is_any_) {
    bright_.assign(static_cast<std::size_t>(width_) *
                       static_cast<std::size_t>(window_.bottom - window_.top + 1),
                   0);
    is_any_ = true;
  }
  const int beside = static_cast<int>(std::ceil(reach_quads));
  for (int v = std::max(window_.top, y - beside); v <= std::min(window_.bottom, y + beside); ++v) {
    for (int u = std::max(window_.left, x - beside); u <= std::min(window_.right, x + beside);
         ++u) {
      if (std::hypot(u - x, v - y) > reach_quads) continue;
      bright_[static_cast<std::size_t>((v - window_.top) * width_) +
              static_cast<std::size_t>(u - window_.left)] = 1;
    }
  }
}

}  // namespace footing::sphere
