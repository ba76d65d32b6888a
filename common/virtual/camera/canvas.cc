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

/// out += weight * in, float by float: the inner loop of all images.
void AddWeighted(float weight, const float* in, std::size_t count, float* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] += weight * in[i];
}

/// One row smoothed along itself, in place.
void BlurRow(float* row, int width, const std::vector<float>& kernel, std::vector<float>& padded) {
  const int reach = static_cast<int>(kernel.size() / 2);
  padded.resize(3 * static_cast<std::size_t>(width + 2 * reach));
  for (int i = 0; i < width + 2 * reach; ++i)
    std::copy_n(row + 3 * std::clamp(i - reach, 0, width - 1), 3, padded.begin() + 3 * i);
  const auto count = 3 * static_cast<std::size_t>(width);
  std::fill_n(row, count, 0.0f);
  for (std::size_t k = 0; k < kernel.size(); ++k)
    AddWeighted(kernel[k], padded.data() + 3 * k, count, row);
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
  const int reach = static_cast<int>(kernel.size() / 2);
  std::vector<float> padded;
  for (int v = 0; v < height_; ++v) BlurRow(At(0, v), width_, kernel, padded);
  const std::vector<float> before = light_;
  std::fill(light_.begin(), light_.end(), 0.0f);
  const auto count = 3 * static_cast<std::size_t>(width_);
  for (int v = 0; v < height_; ++v) {
    for (std::size_t k = 0; k < kernel.size(); ++k) {
      const int from = std::clamp(v + static_cast<int>(k) - reach, 0, height_ - 1);
      AddWeighted(kernel[k], before.data() + Index(0, from), count, At(0, v));
    }
  }
}

}  // namespace footing::virtual_camera
