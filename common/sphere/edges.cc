#include "common/sphere/edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace footing::sphere {
namespace {

using Levels = std::array<double, 3>;

constexpr double kLeastContrastDn = 6;
constexpr double kInsideQuantile = 0.6;
constexpr double kLeastKnownShare = 0.25;  // Of a ring around the blob: not at the sensor's limit.

/// Cut at the image's edges.
QuadWindow Around(const Blob& blob, const Quads& quads, double margin_share) {
  const int size = std::max(blob.right - blob.left, blob.bottom - blob.top) + 1;
  const int margin = 2 + static_cast<int>(margin_share * size);
  return {std::max(0, blob.left - margin), std::max(0, blob.top - margin),
          std::min(quads.width - 1, blob.right + margin),
          std::min(quads.height - 1, blob.bottom + margin)};
}

std::size_t QuadAt(const Quads& quads, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(quads.width) +
         static_cast<std::size_t>(x);
}

/// What the fit sees of a quad: its three colours, or of YUYV its luma, three times.
Levels LevelsAt(const Image& image, const Quads& quads, int x, int y) {
  if (image.format == PixelFormat::kSgrbg8) {
    const std::size_t at = QuadAt(quads, x, y);
    return {double(quads.red[at]), double(quads.green[at]), double(quads.blue[at])};
  }
  const double luma = 0.25 * (image.Value(2 * x, 2 * y) + image.Value(2 * x + 1, 2 * y) +
                              image.Value(2 * x, 2 * y + 1) + image.Value(2 * x + 1, 2 * y + 1));
  return {luma, luma, luma};
}

double Quantile(std::vector<double>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// At the sensor's limit where the sphere is not.
bool Outshines(const Levels& levels, const Levels& inside) {
  for (std::size_t i = 0; i < 3; ++i)
    if (levels[i] >= kClippedDn && inside[i] < kBrightDn) return true;
  return false;
}

/// Levels of each channel, of one quad after the other.
class LevelList {
 public:
  void Add(const Levels& levels) {
    for (std::size_t i = 0; i < 3; ++i) values_[i].push_back(levels[i]);
  }
  std::size_t size() const { return values_[0].size(); }
  Levels At(double quantile) {
    return {Quantile(values_[0], quantile), Quantile(values_[1], quantile),
            Quantile(values_[2], quantile)};
  }

 private:
  std::array<std::vector<double>, 3> values_;
};

Contrast ContrastOf(const Image& image, const Quads& quads, const Blob& blob,
                    const InnerQuads& middle) {
  LevelList inside, outside, clipped;
  for (const auto& [x, y] : middle) inside.Add(LevelsAt(image, quads, x, y));
  Contrast contrast;
  contrast.inside = inside.At(kInsideQuantile);
  const auto look = [&](int x, int y) {
    const Levels levels = LevelsAt(image, quads, x, y);
    (Outshines(levels, contrast.inside) ? clipped : outside).Add(levels);
  };
  const QuadWindow ring = Around(blob, quads, 0.25);
  for (int x = ring.left; x <= ring.right; ++x) {
    look(x, ring.top);
    look(x, ring.bottom);
  }
  for (int y = ring.top + 1; y < ring.bottom; ++y) {
    look(ring.left, y);
    look(ring.right, y);
  }
  const bool is_known = outside.size() > kLeastKnownShare * (outside.size() + clipped.size());
  contrast.outside = (is_known ? outside : clipped).At(0.5);
  return contrast;
}

/// How much of the sphere's light a quad has, 1 inside and 0 outside.
class LightMap {
 public:
  /// Of a quad that outshines the sphere; what lies beside it has more than a millionth of that.
  static constexpr double kOutshone = 1e12;

  LightMap(const Image& image, const Quads& quads, const QuadWindow& window,
           const Contrast& contrast, const PixelNoise& noise)
      : window_(window), width_(window.right - window.left + 1) {
    Levels weight{};
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const auto channel = static_cast<std::size_t>(i);
      const double level = 0.5 * (contrast.inside[channel] + contrast.outside[channel]);
      const double variance = noise.read_dn * noise.read_dn + 0.1 + noise.dn_per_electron * level;
      weight[channel] = contrast.Height(i) / variance;
      sum += weight[channel] * contrast.Height(i);
    }
    const bool is_dark = !Outshines(contrast.outside, contrast.inside);
    for (int y = window.top; y <= window.bottom; ++y) {
      for (int x = window.left; x <= window.right; ++x) {
        const Levels levels = LevelsAt(image, quads, x, y);
        double light = 0;
        for (std::size_t i = 0; i < 3; ++i) light += weight[i] * (levels[i] - contrast.outside[i]);
        const bool is_outshone = is_dark && Outshines(levels, contrast.inside);
        light_.push_back(is_outshone ? kOutshone : light / sum);
      }
    }
  }

  /// Between quads, linear. Nothing beyond the window.
  std::optional<double> At(const Eigen::Vector2d& quad) const {
    const double x = quad.x() - window_.left, y = quad.y() - window_.top;
    const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
    if (x0 < 0 || y0 < 0 || x0 + 1 >= width_ || window_.top + y0 + 1 > window_.bottom)
      return std::nullopt;
    const double a = x - x0, b = y - y0;
    const double* at = light_.data() + y0 * width_ + x0;
    return (1 - b) * ((1 - a) * at[0] + a * at[1]) +
           b * ((1 - a) * at[width_] + a * at[width_ + 1]);
  }

 private:
  QuadWindow window_;
  int width_;
  std::vector<double> light_;
};

/// Where a ray leaves the sphere.
struct Exit {
  double distance = 0;  ///< Quads.
  bool is_outshone = false;
};

/// The distance along a direction at which the light falls through the half, or at which a light
/// that outshines it begins.
std::optional<Exit> ExitAlong(const LightMap& map, const Eigen::Vector2d& from,
                              const Eigen::Vector2d& along) {
  constexpr double kStep = 0.5;
  constexpr double kBright = 1e-6 * LightMap::kOutshone;
  std::optional<double> before = map.At(from);
  for (double r = kStep; before; r += kStep) {
    const auto now = map.At(from + r * along);
    if (!now) return std::nullopt;
    if (*now > kBright) return Exit{r, true};
    if (*now < 0.5) {
      if (*before < 0.5) return std::nullopt;
      return Exit{r - kStep * (0.5 - *now) / (*before - *now), false};
    }
    before = now;
  }
  return std::nullopt;
}

}  // namespace

InnerQuads InnerQuadsOf(const Blob& blob) {
  InnerQuads middle;
  const int step = 1 + (blob.right - blob.left) / 16;
  const Eigen::Vector2d size(blob.right - blob.left + 1, blob.bottom - blob.top + 1);
  for (int y = blob.top; y <= blob.bottom; y += step) {
    for (int x = blob.left; x <= blob.right; x += step) {
      const Eigen::Vector2d from = (Eigen::Vector2d(x, y) - blob.centre).cwiseQuotient(size);
      if (from.norm() < 0.35 || (from.array().abs() * size.array() <= 0.51).all())
        middle.emplace_back(x, y);
    }
  }
  if (middle.empty()) {
    middle.emplace_back(static_cast<int>(std::lround(blob.centre.x())),
                        static_cast<int>(std::lround(blob.centre.y())));
  }
  return middle;
}

Eigen::Vector3d ColourOf(const Quads& quads, const InnerQuads& inner) {
  LevelList inside;
  for (const auto& [x, y] : inner) {
    const std::size_t at = QuadAt(quads, x, y);
    inside.Add({double(quads.red[at]), double(quads.green[at]), double(quads.blue[at])});
  }
  const Levels levels = inside.At(kInsideQuantile);
  return {levels[0], levels[1], levels[2]};
}

std::optional<Edges> FindEdges(const Image& image, const Quads& quads, const Blob& blob,
                               const InnerQuads& inner, const PixelNoise& noise) {
  Edges edges;
  edges.contrast = ContrastOf(image, quads, blob, inner);
  double highest = 0;
  for (int i = 0; i < 3; ++i) highest = std::max(highest, std::abs(edges.contrast.Height(i)));
  if (highest < kLeastContrastDn) return std::nullopt;
  const LightMap map(image, quads, Around(blob, quads, 0.6), edges.contrast, noise);
  for (int i = 0; i < kEdgeRays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kEdgeRays;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const auto exit = ExitAlong(map, blob.centre, along);
    if (!exit) continue;
    // The middle of a quad is half a pixel beyond its first pixel's.
    (exit->is_outshone ? edges.outshone : edges.pixels)
        .emplace_back(2 * (blob.centre + exit->distance * along) + Eigen::Vector2d(0.5, 0.5));
  }
  return edges;
}

}  // namespace footing::sphere
