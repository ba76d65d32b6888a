#include "common/virtual/camera/yuyv.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footing::virtual_camera {
namespace {

/// Colours that a pixel lacks are the mean of those of its eight neighbours.
std::array<double, 3> Demosaiced(const Mosaic& mosaic, int u, int v) {
  std::array<double, 3> sum{}, count{};
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      const int at_u = u + du, at_v = v + dv;
      if (at_u < 0 || at_u >= mosaic.width || at_v < 0 || at_v >= mosaic.height) continue;
      const std::size_t channel = (at_u + at_v) % 2 == 0 ? 1 : at_v % 2 == 0 ? 0 : 2;
      const bool own = (u + v) % 2 == 0 ? channel == 1 : (v % 2 == 0 ? 0u : 2u) == channel;
      if (own && (du != 0 || dv != 0)) continue;
      sum[channel] += mosaic.bytes[static_cast<std::size_t>(at_v * mosaic.width + at_u)];
      count[channel] += 1;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) sum[i] /= std::max(1.0, count[i]);
  return sum;
}

std::uint8_t Byte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::round(value), 0.0, 255.0));
}

}  // namespace

std::vector<std::uint8_t> ToYuyv(const Mosaic& mosaic) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(2 * mosaic.bytes.size());
  for (int v = 0; v < mosaic.height; ++v) {
    for (int u = 0; u + 1 < mosaic.width; u += 2) {
      double luma[2], blue = 0, red = 0;
      for (int i = 0; i < 2; ++i) {
        const auto [r, g, b] = Demosaiced(mosaic, u + i, v);
        luma[i] = 0.299 * r + 0.587 * g + 0.114 * b;
        blue += 0.5 * 0.564 * (b - luma[i]);
        red += 0.5 * 0.713 * (r - luma[i]);
      }
      for (const double value : {luma[0], 128 + blue, luma[1], 128 + red})
        bytes.push_back(Byte(value));
    }
  }
  return bytes;
}

}  // namespace footing::virtual_camera
