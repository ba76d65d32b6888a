#include "common/camera/edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace footing::sphere {
namespace {

using Levels = std::array<double, 3>;

constexpr double kLeastContrastDn = 6;
constexpr double kInsideQuantile = 0.6;
constexpr double kFullDn = 255;             // Upper limit of the sensor.
constexpr double kLeastOutsideShare = 0.2;  // Share of the ring: without a lamp.

/// Levels of a quad for the fit: its three colours, or of YUYV its luma, three times.
Levels LevelsAt(const Image& image, const Quads& quads, int x, int y) {
  if (image.format == PixelFormat::kSgrbg8) {
    const std::size_t at = quads.At(x, y);
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

Contrast ContrastOf(const Image& image, const Quads& quads, const Blob& blob,
                    const InnerQuads& middle, Surroundings around) {
  std::array<std::vector<double>, 3> inside, outside;
  const auto add = [&](std::array<std::vector<double>, 3>& to, int x, int y) {
    const Levels levels = LevelsAt(image, quads, x, y);
    for (std::size_t i = 0; i < 3; ++i) to[i].push_back(levels[i]);
  };
  for (const auto& [x, y] : middle) add(inside, x, y);
  const QuadWindow ring = Around(blob, quads, 0.25);
  int count = 0;
  const auto add_outside = [&](int x, int y) {
    ++count;
    if (around == Surroundings::kAny || quads.LeastAt(x, y) < kWhiteDn) add(outside, x, y);
  };
  for (int x = ring.left; x <= ring.right; ++x) {
    add_outside(x, ring.top);
    add_outside(x, ring.bottom);
  }
  for (int y = ring.top + 1; y < ring.bottom; ++y) {
    add_outside(ring.left, y);
    add_outside(ring.right, y);
  }
  if (static_cast<double>(outside[0].size()) < kLeastOutsideShare * count)
    return ContrastOf(image, quads, blob, middle, Surroundings::kAny);  // A lamp all around.
  Contrast contrast;
  for (std::size_t i = 0; i < 3; ++i) {
    contrast.inside[i] = Quantile(inside[i], kInsideQuantile);
    contrast.outside[i] = Quantile(outside[i], 0.5);
  }
  return contrast;
}

/// How much of the sphere's light a quad has, 1 inside and 0 outside.
class LightMap {
 public:
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
    for (int y = window.top; y <= window.bottom; ++y) {
      for (int x = window.left; x <= window.right; ++x) {
        const Levels levels = LevelsAt(image, quads, x, y);
        double light = 0;
        for (std::size_t i = 0; i < 3; ++i) light += weight[i] * (levels[i] - contrast.outside[i]);
        light_.push_back(light / sum);
      }
    }
  }

  /// Alike before a lamp: by the least of the three colours, 0 at the sensor's limit.
  LightMap(const Quads& quads, const QuadWindow& window, const Contrast& contrast)
      : window_(window), width_(window.right - window.left + 1) {
    const double inside = *std::min_element(contrast.inside.begin(), contrast.inside.end());
    for (int y = window.top; y <= window.bottom; ++y) {
      for (int x = window.left; x <= window.right; ++x)
        light_.push_back((kFullDn - quads.LeastAt(x, y)) / std::max(1.0, kFullDn - inside));
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

/// Distance along a direction at which the light falls through the half, quads.
std::optional<double> FallAlong(const LightMap& map, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& along) {
  constexpr double kStep = 0.5;
  std::optional<double> before = map.At(from);
  for (double r = kStep; before; r += kStep) {
    const auto now = map.At(from + r * along);
    if (!now) return std::nullopt;
    if (*now < 0.5) {
      if (*before < 0.5) return std::nullopt;
      return r - kStep * (0.5 - *now) / (*before - *now);
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
  std::array<std::vector<double>, 3> inside;
  for (const auto& [x, y] : inner) {
    const std::size_t at = quads.At(x, y);
    inside[0].push_back(quads.red[at]);
    inside[1].push_back(quads.green[at]);
    inside[2].push_back(quads.blue[at]);
  }
  return {Quantile(inside[0], kInsideQuantile), Quantile(inside[1], kInsideQuantile),
          Quantile(inside[2], kInsideQuantile)};
}

std::optional<Edges> FindEdges(const Image& image, const Quads& quads, const Blob& blob,
                               const InnerQuads& inner, const PixelNoise& noise,
                               Surroundings around) {
  Edges edges;
  edges.contrast = ContrastOf(image, quads, blob, inner, around);
  double highest = 0;
  for (int i = 0; i < 3; ++i) highest = std::max(highest, std::abs(edges.contrast.Height(i)));
  if (highest < kLeastContrastDn) return std::nullopt;
  const QuadWindow window = Around(blob, quads, 0.6);
  const LightMap map(image, quads, window, edges.contrast, noise);
  std::optional<LightMap> lamp;
  if (around == Surroundings::kLamp) lamp.emplace(quads, window, edges.contrast);
  for (int i = 0; i < kEdgeRays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kEdgeRays;
    const Eigen::Vector2d along(std::cos(angle), std::sin(angle));
    const auto fall = FallAlong(map, blob.centre, along);
    const auto rise = lamp ? FallAlong(*lamp, blob.centre, along) : std::optional<double>();
    if (!fall && !rise) continue;
    const bool at_lamp = rise && (!fall || *rise < *fall);
    const double r = at_lamp ? *rise : *fall;
    // The middle of a quad is half a pixel beyond its first pixel's.
    edges.pixels.emplace_back(2 * (blob.centre + r * along) + Eigen::Vector2d(0.5, 0.5));
    edges.at_lamp.push_back(at_lamp);
  }
  return edges;
}

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
