// Which pixels take part in the fit.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/camera/disc_fitter.h"
#include "common/camera/disc_ring.h"

namespace footing::sphere {
namespace disc {
namespace {

constexpr int kClippedDn = 250;
constexpr double kHiddenBlurs = 3.5;  // How far its light reaches beyond an occluder's edge.
constexpr double kBesideBlurs = 2.5;  // Along the sphere's edge, where half of it is seen.

}  // namespace

void Fitter::Collect(const Image& image, const LocalSlopes& slopes,
                     const Eigen::Vector2d& middle_px, const State& state, double far_blurs,
                     int most_pixels) {
  samples_.clear();
  inside_ = clipped_ = 0;
  const double per_px = std::sqrt(slopes.scale().determinant());
  const double radius_px = state.shape[2] / per_px;
  const double reach_px = 1.25 * radius_px + (far_blurs + 1) * settings_.profile.blur_px;
  const int u0 = 2 * static_cast<int>(std::max(0.0, middle_px.x() - reach_px) / 2);
  const int v0 = 2 * static_cast<int>(std::max(0.0, middle_px.y() - reach_px) / 2);
  const int u1 = std::min(image.width - 1, static_cast<int>(middle_px.x() + reach_px));
  const int v1 = std::min(image.height - 1, static_cast<int>(middle_px.y() + reach_px));
  const double ring_px = 2 * (far_blurs + 2.5) * settings_.profile.blur_px;
  const double expected = 2 * std::numbers::pi * radius_px * std::min(radius_px, ring_px);
  const int every = 1 + static_cast<int>(expected / most_pixels);
  int quad = 0;
  for (int v = v0; v < v1; v += 2) {
    for (int u = u0; u < u1; u += 2)
      CollectQuad(image, slopes, middle_px, state, u, v, far_blurs, quad, every);
  }
}

void Fitter::CollectQuad(const Image& image, const LocalSlopes& slopes,
                         const Eigen::Vector2d& middle_px, const State& state, int u, int v,
                         double far_blurs, int& quad, int every) {
  if (lit_.At(u / 2, v / 2)) return;
  const Eigen::Vector2d at = slopes.At(u + 0.5, v + 0.5);
  const double beyond = BeyondOf(at, state);
  if (beyond > far_blurs + 1.5) return;
  // The middle says little of where the edge is.
  const bool is_middle = beyond < -5;
  ++quad;
  if (quad % (is_middle ? 4 * every : every) != 0) return;
  for (int i = 0; i < 4; ++i) {
    const int at_u = u + i % 2, at_v = v + i / 2;
    Sample sample;
    sample.value = image.Value(at_u, at_v);
    if (beyond < -1) {
      ++inside_;
      clipped_ += sample.value >= kClippedDn ? 1 : 0;
    }
    if (sample.value >= kClippedDn) continue;
    sample.slopes = slopes.At(at_u, at_v);
    sample.channel = image.Channel(at_u, at_v);
    sample.later = (at_v - middle_px.y()) * settings_.shutter.row_s / settings_.shutter.exposure_s;
    const Eigen::Vector2d pixel_from = sample.slopes - state.shape.head<2>();
    sample.sector = SectorOf(pixel_from);
    samples_.push_back(sample);
  }
}

/// How far outside of a state's edge, in blurs.
double Fitter::BeyondOf(const Eigen::Vector2d& slopes, const State& state) const {
  const Eigen::Vector2d from = slopes - state.shape.head<2>();
  const double r = std::max(1e-9, from.norm());
  return (r - state.shape[2]) / (settings_.profile.blur_px * scale_.Along(from / r));
}

std::vector<bool> Fitter::Limit(const State& state, const SectorReach& reach) {
  const double blur = Blur();
  std::vector<bool> seen(kSectors);
  for (std::size_t s = 0; s < kSectors; ++s) seen[s] = std::isinf(reach[s]);
  const double arc = 2 * std::numbers::pi / kSectors * state.shape[2];
  const std::vector<bool> sectors = WithoutBorders(seen, kBesideBlurs * blur / arc);
  std::erase_if(samples_, [&](const Sample& sample) {
    const auto s = static_cast<std::size_t>(sample.sector);
    const double r = (sample.slopes - state.shape.head<2>()).norm();
    const double edge = sectors[s] ? reach[s] : std::min(reach[s], state.shape[2]);
    return r > edge - kHiddenBlurs * blur;
  });
  return sectors;
}

void Fitter::LookBehind(const State& state, double moving_px, std::vector<bool>& sectors) {
  for (Sample& sample : samples_) sample.beyond = BeyondOf(sample.slopes, state);
  disc::LookBehind(samples_, state, settings_.noise, 0.5 * moving_px / settings_.profile.blur_px,
                   sectors);
}

void Fitter::KeepBefore(const Eigen::Vector2d& at, const Eigen::Vector2d& away, double margin) {
  std::erase_if(samples_,
                [&](const Sample& sample) { return (sample.slopes - at).dot(away) > -margin; });
}

int Fitter::DropSectors(std::vector<bool>& sectors) {
  std::array<double, kSectors> sum{}, square{}, count{}, amplitude{};
  for (const Sample& sample : samples_) {
    if (sample.beyond < -2.5) continue;
    const auto s = static_cast<std::size_t>(sample.sector);
    sum[s] += sample.residual;
    square[s] += std::min(sample.residual * sample.residual, 100.0);
    amplitude[s] += sample.height;
    ++count[s];
  }
  int dropped = 0;
  for (std::size_t s = 0; s < kSectors; ++s) {
    if (!sectors[s] || count[s] < 3) continue;
    // Noise alone, and 1.5 % of the contrast that no model of a lamp explains.
    const double slack = 0.015 * amplitude[s] / count[s];
    const double mean = std::abs(sum[s] / count[s]), rms = std::sqrt(square[s] / count[s]);
    const bool fits = mean < 3.5 / std::sqrt(count[s]) + slack &&
                      rms < 1 + 3.0 / std::sqrt(2 * count[s]) + 2 * slack;
    if (fits) continue;
    sectors[s] = false;
    ++dropped;
  }
  std::erase_if(samples_, [&](const Sample& sample) {
    return !sectors[static_cast<std::size_t>(sample.sector)] && sample.beyond > -2.5;
  });
  return dropped;
}

}  // namespace disc

int SectorOf(const Eigen::Vector2d& from) {
  // Borders of the sectors of an eighth, as tangents.
  static const std::array<double, kSectors / 8> kBorders = [] {
    std::array<double, kSectors / 8> borders{};
    for (std::size_t i = 0; i < borders.size(); ++i)
      borders[i] = std::tan(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kSectors);
    return borders;
  }();
  const double u = std::abs(from.x()), v = std::abs(from.y());
  const double low = std::min(u, v), high = std::max(u, v);
  int sector = 0;
  for (const double border : kBorders) sector += low > border * high ? 1 : 0;
  if (v > u) sector = kSectors / 4 - sector;
  if (from.x() < 0) sector = kSectors / 2 - sector;
  if (from.y() < 0) sector = kSectors - sector;
  return sector % kSectors;
}

}  // namespace footing::sphere
