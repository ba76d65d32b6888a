#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/camera/image.h"

namespace footing::frames {

/// A frame and when its middle row was exposed.
struct Frame {
  sphere::PixelFormat format = sphere::PixelFormat::kSgrbg8;
  int width = 0, height = 0;
  std::vector<std::uint8_t> bytes;
  std::optional<std::int64_t> time_ns;  ///< As the frame says, on whatever clock.

  sphere::Image View() const { return {format, width, height, bytes}; }
};

}  // namespace footing::frames
