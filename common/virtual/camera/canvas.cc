#include "common/virtual/camera/canvas.h"

#include <algorithm>
#include <cmath>

namespace footing::virtual_camera {
namespace {

std::vector<float> GaussianKernel(double sd_px) {
  const int reach = static_cast<int>(std::ceil(4 * sd_px));
  std::vector<float> kernel;
  float sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    kernel.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sd_px * sd_px))));
    sum += kernel.back();
  }
  for (float& weight : kernel) weight /= sum;
  return kernel;
}

/// One line of `count` pixels that are `step` floats apart, smoothed in place.
void BlurLine(float* line, int count, std::size_t step, const std::vector<float>& kernel,
              std::vector<float>& padded) {
  const int reach = static_cast<int>(kernel.size() / 2);
  padded.resize(3 * static_cast<std::size_t>(count + 2 * reach));
  for (int i = 0; i < count + 2 * reach; ++i) {
    const auto from = static_cast<std::size_t>(std::clamp(i - reach, 0, count - 1)) * step;
    std::copy_n(line + from, 3, padded.begin() + 3 * i);
  }
  for (int i = 0; i < count; ++i) {
    float sum[3] = {0, 0, 0};
    const float* in = padded.data() + 3 * i;
    for (const float weight : kernel) {
      for (float& channel : sum) channel += weight * *in++;
    }
    std::copy_n(sum, 3, line + static_cast<std::size_t>(i) * step);
  }
}

}  // namespace

Eigen::Vector3f Canvas::Between(double u_px, double v_px) const {
  const double u = std::clamp(u_px, 0.0, width_ - 1.0), v = std::clamp(v_px, 0.0, height_ - 1.0);
  const int u0 = std::min(static_cast<int>(u), width_ - 2);
  const int v0 = std::min(static_cast<int>(v), height_ - 2);
  const auto a = static_cast<float>(u - u0), b = static_cast<float>(v - v0);
  const auto pixel = [this](int at_u, int at_v) {
    return Eigen::Map<const Eigen::Vector3f>(At(at_u, at_v));
  };
  return (1 - b) * ((1 - a) * pixel(u0, v0) + a * pixel(u0 + 1, v0)) +
         b * ((1 - a) * pixel(u0, v0 + 1) + a * pixel(u0 + 1, v0 + 1));
}

void Canvas::Blur(double sd_px) {
  if (sd_px <= 0) return;
  const std::vector<float> kernel = GaussianKernel(sd_px);
  std::vector<float> padded;
  const std::size_t row = 3 * static_cast<std::size_t>(width_);
  for (int v = 0; v < height_; ++v) BlurLine(At(0, v), width_, 3, kernel, padded);
  for (int u = 0; u < width_; ++u) BlurLine(At(u, 0), height_, row, kernel, padded);
}

}  // namespace footing::virtual_camera
