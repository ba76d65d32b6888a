#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/virtual/camera/canvas.h"
#include "common/virtual/camera/scene.h"
#include "common/virtual/devices/noise.h"

namespace footing::virtual_camera {

/// The frame that the sensor reads of a scene, ray by ray: balls are supersampled 64-fold (25-fold
/// from 15 px of radius on), each row at its own time and a moving ball nine times during the
/// exposure; then the point spread, halo, mosaic, shot and read noise, rounding and clipping at
/// 255. A ball nearer than 0.1 m, or beyond the image, is not drawn.
Mosaic Render(const Scene& scene, noise::Random& random);

/// Frames of a scene at rest, one after the other: traced once, each read with noise of its own.
std::vector<Mosaic> RenderStill(const Scene& scene, int frames, noise::Random& random);

/// Reading of the sensor for the light on it: mosaic, shot and read noise, rounding and clipping.
Mosaic ReadOut(const Scene& scene, const Canvas& canvas, noise::Random& random);

/// Normal numbers by the hundred thousand, for the pixels of a frame: xoshiro256++ (Blackman &
/// Vigna 2021) begun by a noise::Random, so that its bits depend on that one's seed alone.
class PixelNoise {
 public:
  explicit PixelNoise(noise::Random& random) {
    for (std::uint64_t& word : state_)
      word = static_cast<std::uint64_t>(random.Uniform() * 0x1.0p53) * 2048 + 1;
  }

  /// Mean 0, standard deviation 1: the sum of eight 16-bit uniforms, within +-4.9.
  double Normal() {
    constexpr std::uint64_t kLanes = 0x0000ffff0000ffff;
    const std::uint64_t a = Next(), b = Next();
    const std::uint64_t sums =
        (a & kLanes) + (a >> 16 & kLanes) + (b & kLanes) + (b >> 16 & kLanes);
    const auto sum = static_cast<double>((sums & 0xffffffff) + (sums >> 32));
    // Mean 8 * 65535 / 2; variance 8 (65536² - 1) / 12.
    return (sum - 262140) * (1 / 53509.92);
  }

 private:
  std::uint64_t Next() {
    const auto turn = [](std::uint64_t x, int by) { return x << by | x >> (64 - by); };
    const std::uint64_t result = turn(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = turn(state_[3], 45);
    return result;
  }

  std::array<std::uint64_t, 4> state_;
};

}  // namespace footing::virtual_camera
