#include "common/virtual/camera/render.h"

#include <algorithm>
#include <cmath>

#include "common/virtual/camera/canvas.h"

namespace footing::virtual_camera {
namespace {

constexpr double kNearestM = 0.1;

/// Share of a pixel that a shape covers, from the distance to its edge.
double Coverage(const Shape& shape, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d from = pixel - shape.centre_px;
  const double c = std::cos(shape.turn_rad), s = std::sin(shape.turn_rad);
  const Eigen::Vector2d at(c * from.x() + s * from.y(), -s * from.x() + c * from.y());
  double beyond_px = 0;
  if (shape.kind == Shape::Kind::kRectangle) {
    beyond_px = (at.cwiseAbs() - shape.half_px).maxCoeff();
  } else {
    const double share = at.cwiseQuotient(shape.half_px).norm();
    beyond_px = (share - 1) * shape.half_px.minCoeff();
  }
  return std::clamp(0.5 - beyond_px, 0.0, 1.0);
}

void Paint(const Shape& shape, Canvas& canvas) {
  const double reach = shape.half_px.norm() + 2;
  const auto first = [reach](double centre) {
    return std::max(0, static_cast<int>(centre - reach));
  };
  const int last_u = std::min(canvas.width() - 1, static_cast<int>(shape.centre_px.x() + reach));
  const int last_v = std::min(canvas.height() - 1, static_cast<int>(shape.centre_px.y() + reach));
  for (int v = first(shape.centre_px.y()); v <= last_v; ++v) {
    for (int u = first(shape.centre_px.x()); u <= last_u; ++u) {
      const auto share = static_cast<float>(Coverage(shape, {u, v}));
      Eigen::Map<Eigen::Vector3f> light(canvas.At(u, v));
      light += share * (shape.colour_dn.cast<float>() - light);
    }
  }
}

Canvas Background(const Scene& scene) {
  Canvas canvas(scene.lens.width, scene.lens.height);
  for (int v = 0; v < canvas.height(); ++v) {
    for (int u = 0; u < canvas.width(); ++u) {
      const double across = static_cast<double>(u) / canvas.width();
      Eigen::Map<Eigen::Vector3f>(canvas.At(u, v)) =
          (scene.background_dn + across * scene.background_slope_dn).cast<float>();
    }
  }
  for (const Shape& shape : scene.shapes) Paint(shape, canvas);
  return canvas;
}

/// Light of a ball along a ray; nothing when it misses.
std::optional<Eigen::Vector3d> Radiance(const Ball& ball, const Eigen::Vector3d& centre_C_m,
                                        const Eigen::Vector3d& ray) {
  const double along = ray.dot(centre_C_m);
  const double inside = along * along - centre_C_m.squaredNorm() + ball.radius_m * ball.radius_m;
  if (inside < 0) return std::nullopt;
  const Eigen::Vector3d normal = ((along - std::sqrt(inside)) * ray - centre_C_m) / ball.radius_m;
  const double cosine = std::max(0.0, -normal.dot(ray));
  const double disc =
      ball.limb_power > 0 ? std::pow(cosine, ball.limb_power) : 1 - ball.limb * (1 - cosine);
  return ball.colour_dn * disc * (1 + ball.hot_spot * normal.y());
}

/// Part of the image around a ball, in whole pixels, with its rays at the pixels' corners.
class Patch {
 public:
  Patch(const Scene& scene, int u0, int v0, int width, int height, int fold)
      : scene_(scene), u0_(u0), v0_(v0), width_(width), height_(height), fold_(fold) {
    for (int v = 0; v <= height; ++v) {
      for (int u = 0; u <= width; ++u)
        corners_.push_back(RayThrough(scene.lens, {u0 + u - 0.5, v0 + v - 0.5}));
    }
  }

  /// All balls and occluders over the background, blurred, into `out`.
  void Trace(const Canvas& background, Canvas& out) const {
    Canvas fine(width_ * fold_, height_ * fold_);
    const bool moves = std::any_of(scene_.balls.begin(), scene_.balls.end(),
                                   [](const Ball& ball) { return ball.v_C_mps.squaredNorm() > 0; });
    const int exposures = moves ? 9 : 1;
    for (int v = 0; v < fine.height(); ++v) {
      for (int u = 0; u < fine.width(); ++u) {
        Eigen::Vector3d light = Eigen::Vector3d::Zero();
        for (int i = 0; i < exposures; ++i) {
          const double share = (i + 0.5) / exposures - 0.5;
          light += LightAt(background, u, v, share * scene_.sensor.exposure_s);
        }
        Eigen::Map<Eigen::Vector3f>(fine.At(u, v)) = (light / exposures).cast<float>();
      }
    }
    fine.Blur(scene_.sensor.psf_px * fold_);
    Shrink(fine, out);
  }

 private:
  Eigen::Vector3d LightAt(const Canvas& background, int fine_u, int fine_v, double after_s) const {
    const double u = (fine_u + 0.5) / fold_, v = (fine_v + 0.5) / fold_;
    const Eigen::Vector2d pixel(u0_ + u - 0.5, v0_ + v - 0.5);
    for (const Occluder& occluder : scene_.occluders) {
      if ((pixel - occluder.point_px).dot(occluder.towards_hidden) > 0) return occluder.colour_dn;
    }
    const Eigen::Vector3d ray = RayAt(u, v);
    const double time_s = RowTime(scene_, pixel.y()) + after_s;
    for (const Ball& ball : scene_.balls) {
      if (const auto light = Radiance(ball, ball.p_C_m + time_s * ball.v_C_mps, ray)) return *light;
    }
    return background.Between(pixel.x(), pixel.y()).cast<double>();
  }

  Eigen::Vector3d RayAt(double u, double v) const {
    const int column = static_cast<int>(u), row = static_cast<int>(v);
    const double a = u - column, b = v - row;
    const auto corner = [this](int at_u, int at_v) -> const Eigen::Vector3d& {
      return corners_[static_cast<std::size_t>(at_v * (width_ + 1) + at_u)];
    };
    return ((1 - b) * ((1 - a) * corner(column, row) + a * corner(column + 1, row)) +
            b * ((1 - a) * corner(column, row + 1) + a * corner(column + 1, row + 1)))
        .normalized();
  }

  /// The inner pixels; the outermost ones lack what the blur would bring from outside.
  void Shrink(const Canvas& fine, Canvas& out) const {
    const int margin = static_cast<int>(std::ceil(4 * scene_.sensor.psf_px));
    const float share = 1.0f / static_cast<float>(fold_ * fold_);
    for (int v = margin; v < height_ - margin; ++v) {
      for (int u = margin; u < width_ - margin; ++u) {
        if (u0_ + u < 0 || u0_ + u >= out.width() || v0_ + v < 0 || v0_ + v >= out.height())
          continue;
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int i = 0; i < fold_ * fold_; ++i)
          sum += Eigen::Map<const Eigen::Vector3f>(
              fine.At(u * fold_ + i % fold_, v * fold_ + i / fold_));
        Eigen::Map<Eigen::Vector3f>(out.At(u0_ + u, v0_ + v)) = share * sum;
      }
    }
  }

  const Scene& scene_;
  int u0_, v0_, width_, height_, fold_;
  std::vector<Eigen::Vector3d> corners_;
};

struct Extent {
  Eigen::Vector2d centre_px;
  double reach_px = 0;
};

/// Extent of a ball in the image, generously; nothing when it is not in sight.
std::optional<Extent> ExtentOf(const Scene& scene, const Ball& ball) {
  if (ball.p_C_m.z() < kNearestM) return std::nullopt;
  Extent extent{Project(scene.lens, ball.p_C_m), 0};
  const double f = std::max(scene.lens.fx_px, scene.lens.fy_px);
  const double z = ball.p_C_m.z() - ball.radius_m;
  const double obliqueness = ball.p_C_m.squaredNorm() / (ball.p_C_m.z() * ball.p_C_m.z());
  const double travel_s = 0.5 * (scene.sensor.exposure_s + scene.sensor.readout_s);
  extent.reach_px = f * (1.1 * ball.radius_m * obliqueness + ball.v_C_mps.norm() * travel_s) / z +
                    10 * scene.sensor.psf_px + 2;
  const auto& c = extent.centre_px;
  if (c.x() < -extent.reach_px || c.x() > scene.lens.width + extent.reach_px ||
      c.y() < -extent.reach_px || c.y() > scene.lens.height + extent.reach_px)
    return std::nullopt;
  return extent;
}

void TraceBall(const Scene& scene, const Extent& extent, const Canvas& background, Canvas& out) {
  const int u0 = static_cast<int>(std::floor(extent.centre_px.x() - extent.reach_px));
  const int v0 = static_cast<int>(std::floor(extent.centre_px.y() - extent.reach_px));
  const int size = 2 * static_cast<int>(std::ceil(extent.reach_px)) + 1;
  const int fold = extent.reach_px < 28 ? 8 : 5;
  Patch(scene, u0, v0, size, size, fold).Trace(background, out);
}

void AddHalo(const Scene& scene, const Ball& ball, Canvas& canvas) {
  if (ball.halo <= 0) return;
  const Eigen::Vector2d centre = Project(scene.lens, ball.p_C_m);
  const double radius_px = scene.lens.fx_px * ball.radius_m / ball.p_C_m.z();
  for (int v = 0; v < canvas.height(); ++v) {
    for (int u = 0; u < canvas.width(); ++u) {
      const double beyond_px = std::max(0.0, (Eigen::Vector2d(u, v) - centre).norm() - radius_px);
      const double share = ball.halo * std::exp(-beyond_px / ball.halo_px);
      if (share < 1e-4) continue;
      Eigen::Map<Eigen::Vector3f>(canvas.At(u, v)) += (share * ball.colour_dn).cast<float>();
    }
  }
}

/// Red, green or blue of the mosaic G R / B G.
int ChannelAt(int u, int v) { return (u + v) % 2 == 0 ? 1 : v % 2 == 0 ? 0 : 2; }

}  // namespace

Mosaic ReadOut(const Scene& scene, const Canvas& canvas, noise::Random& random) {
  Mosaic mosaic{canvas.width(), canvas.height(), {}};
  mosaic.bytes.reserve(static_cast<std::size_t>(mosaic.width * mosaic.height));
  PixelNoise noise(random);
  const double read_variance = scene.sensor.read_noise_dn * scene.sensor.read_noise_dn;
  for (int v = 0; v < mosaic.height; ++v) {
    for (int u = 0; u < mosaic.width; ++u) {
      const double light = std::max(0.0f, canvas.At(u, v)[ChannelAt(u, v)]);
      const double sd = std::sqrt(read_variance + scene.sensor.dn_per_electron * light);
      const double read = std::clamp(light + sd * noise.Normal(), 0.0, 255.0);
      mosaic.bytes.push_back(static_cast<std::uint8_t>(read + 0.5));
    }
  }
  return mosaic;
}

double RowTime(const Scene& scene, double row_px) {
  const double rows = std::max(1, scene.lens.height - 1);
  return scene.sensor.readout_s * (row_px / rows - 0.5);
}

std::optional<Seen> Truth(const Scene& scene, const Ball& ball) {
  Seen seen{ball.p_C_m, 0};
  for (int i = 0; i < 20; ++i) {
    if (seen.p_C_m.z() < kNearestM) return std::nullopt;
    seen.after_s = RowTime(scene, Project(scene.lens, seen.p_C_m).y());
    seen.p_C_m = ball.p_C_m + seen.after_s * ball.v_C_mps;
  }
  return seen;
}

namespace {

/// Light before the sensor reads it.
Canvas Trace(const Scene& scene) {
  const Canvas background = Background(scene);
  Canvas canvas = background;
  if (!scene.shapes.empty()) canvas.Blur(scene.sensor.psf_px);
  for (const Ball& ball : scene.balls) {
    if (const auto extent = ExtentOf(scene, ball)) TraceBall(scene, *extent, background, canvas);
  }
  for (const Ball& ball : scene.balls) AddHalo(scene, ball, canvas);
  return canvas;
}

}  // namespace

Mosaic Render(const Scene& scene, noise::Random& random) {
  return ReadOut(scene, Trace(scene), random);
}

std::vector<Mosaic> RenderStill(const Scene& scene, int frames, noise::Random& random) {
  const Canvas canvas = Trace(scene);
  std::vector<Mosaic> mosaics;
  for (int i = 0; i < frames; ++i) mosaics.push_back(ReadOut(scene, canvas, random));
  return mosaics;
}

}  // namespace footing::virtual_camera
