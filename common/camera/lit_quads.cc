#include "common/camera/lit_quads.h"

#include <algorithm>

namespace footing::sphere {
namespace {

constexpr int kReach = 2;  // Four pixels, which are four blurs of a lens.
constexpr double kMarginShare = 0.6;

}  // namespace

LitQuads::LitQuads(const Quads& quads, const Blob& blob)
    : window_(Around(blob, quads, kMarginShare)) {
  const int width = window_.right - window_.left + 1, height = window_.bottom - window_.top + 1;
  lit_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const int last_x = std::min(quads.width - 1, window_.right + kReach);
  const int last_y = std::min(quads.height - 1, window_.bottom + kReach);
  for (int y = std::max(0, window_.top - kReach); y <= last_y; ++y) {
    for (int x = std::max(0, window_.left - kReach); x <= last_x; ++x) {
      if (quads.LeastAt(x, y) < kWhiteDn) continue;
      any_ = true;
      for (int v = std::max(window_.top, y - kReach); v <= std::min(window_.bottom, y + kReach);
           ++v) {
        for (int u = std::max(window_.left, x - kReach); u <= std::min(window_.right, x + kReach);
             ++u)
          lit_[Place(u, v)] = true;
      }
    }
  }
}

}  // namespace footing::sphere
