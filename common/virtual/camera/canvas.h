#pragma once

#include <Eigen/Core>
#include <vector>

namespace footing::virtual_camera {

/// Light on the sensor, DN of red, green and blue per pixel, before mosaic and noise.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(width),
        height_(height),
        light_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  float* At(int u, int v) { return light_.data() + Index(u, v); }
  const float* At(int u, int v) const { return light_.data() + Index(u, v); }
  /// Between pixels, linear; beyond the edge as at the edge.
  Eigen::Vector3f Between(double u_px, double v_px) const;
  /// Convolved with a Gaussian of this standard deviation, px; beyond the edge as at the edge.
  void Blur(double sd_px);

 private:
  std::size_t Index(int u, int v) const {
    return 3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
                static_cast<std::size_t>(u));
  }
  int width_, height_;
  std::vector<float> light_;
};

}  // namespace footing::virtual_camera
