#include "clients/camera/preview_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace footing::camera {
namespace {

constexpr int kMostWidth = 320;
constexpr double kColourShare = 0.25;  // Of a sphere's chroma, as the finder's own.

using Levels = std::array<std::uint8_t, 256>;

/// A mosaic has the sensor's linear values, which a screen shows too dark; YUYV has a screen's own.
Levels LevelsOf(sphere::PixelFormat format) {
  Levels levels{};
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double share = static_cast<double>(i) / 255;
    const double shown = format == sphere::PixelFormat::kSgrbg8 ? std::sqrt(share) : share;
    levels[i] = static_cast<std::uint8_t>(std::lround(255 * shown));
  }
  return levels;
}

preview::Circle ToCircle(const Eigen::Vector2d& centre_px, double radius_px) {
  return {static_cast<float>(centre_px.x()), static_cast<float>(centre_px.y()),
          static_cast<float>(radius_px)};
}

preview::Circle CircleOf(const sphere::Blob& blob) {
  const int quads = std::max(blob.right - blob.left, blob.bottom - blob.top) + 1;
  return ToCircle(2 * blob.centre + Eigen::Vector2d(0.5, 0.5), quads);
}

bool IsRefused(const preview::Circle& light, const std::vector<sphere::Circle>& refused) {
  return std::any_of(refused.begin(), refused.end(), [&](const sphere::Circle& place) {
    return (place.centre_px - Eigen::Vector2d(light.u_px, light.v_px)).norm() < place.radius_px;
  });
}

}  // namespace

void PreviewPainter::PaintPixels(const SeenFrame& seen, preview::Picture& picture) const {
  const int step = (quads_.width + kMostWidth - 1) / kMostWidth;
  picture.width = quads_.width / step;
  picture.height = quads_.height / step;
  const Levels levels = LevelsOf(seen.frame.format);
  const std::vector<std::int16_t>* const planes[] = {&quads_.red, &quads_.green, &quads_.blue};
  picture.rgb.reserve(std::size_t{3} * static_cast<std::size_t>(picture.width) *
                      static_cast<std::size_t>(picture.height));
  for (int v = 0; v < picture.height; ++v) {
    for (int u = 0; u < picture.width; ++u) {
      for (const auto* plane : planes) {
        int sum = 0;
        for (int row = v * step; row < (v + 1) * step; ++row)
          for (int column = u * step; column < (u + 1) * step; ++column)
            sum += (*plane)[static_cast<std::size_t>(row * quads_.width + column)];
        picture.rgb.push_back(
            levels[static_cast<std::size_t>(std::clamp(sum / (step * step), 0, 255))]);
      }
    }
  }
}

preview::Sphere PreviewPainter::SightOf(const SeenFrame& seen, std::size_t sphere) const {
  preview::Sphere shown;
  shown.role = spheres_[sphere].role;
  const LightVerdict& verdict = seen.verdicts[sphere];
  if (const auto& found = seen.found[sphere]) {
    shown.sight = verdict.accepts ? preview::Sight::kSeen : preview::Sight::kChecking;
    shown.confidence = static_cast<float>(found->confidence);
    shown.range_m = static_cast<float>(found->p_C_m.norm());
    shown.is_saturated = found->is_saturated;
    shown.is_occluded = found->is_occluded;
    shown.circle = ToCircle(found->centre_px, found->radius_px);
    return shown;
  }
  if (verdict.is_switching) {
    shown.sight = preview::Sight::kChecking;
    return shown;
  }
  const auto blobs = sphere::FindBlobs(quads_, sphere::Whole(seen.frame.View()),
                                       spheres_[sphere].target.colour_dn, kColourShare);
  double best = 0;
  for (const sphere::Blob& blob : blobs) {
    const preview::Circle circle = CircleOf(blob);
    if (blob.score <= best || IsRefused(circle, verdict.refused)) continue;
    best = blob.score;
    shown.sight = preview::Sight::kOther;
    shown.circle = circle;
  }
  return shown;
}

preview::Picture PreviewPainter::Paint(const SeenFrame& seen) {
  sphere::ToQuads(seen.frame.View(), quads_);
  preview::Picture picture;
  picture.number = seen.number;
  picture.exposed_ns = seen.exposed_ns;
  picture.camera_width = seen.frame.width;
  picture.camera_height = seen.frame.height;
  picture.has_pose = seen.has_pose;
  picture.simulated = seen.simulated;
  PaintPixels(seen, picture);
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    picture.spheres.push_back(SightOf(seen, i));
    for (const sphere::Circle& place : seen.verdicts[i].refused)
      picture.refused.push_back({spheres_[i].role, ToCircle(place.centre_px, place.radius_px)});
  }
  return picture;
}

}  // namespace footing::camera
