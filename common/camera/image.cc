#include "common/camera/image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/camera/blobs.h"

namespace footing::sphere {
namespace {

constexpr double kLeastRiseDn = 20;  // Rise of the sum of three colours, mean of 3 x 3 quads.
constexpr double kSpotShare = 0.35;  // Share of the brightest; a lens scatters less than that.
constexpr double kRivalShare = 0.4;  // Share of the sphere's light; a table reflects less.
constexpr double kLeastFill = 0.65;  // Share of the box, as an ellipse; half a disc has 0.5.
constexpr double kMostAspect = 1.6;
constexpr int kLimitDn = 250;

/// Light that came with the lamp, of every quad: three colours together, DN.
struct Rise {
  int width = 0, height = 0;
  std::vector<int> light;
  int At(int x, int y) const {
    return light[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(x)];
  }
};

Rise RiseOf(const Quads& dark, const Quads& lit) {
  Rise rise{lit.width, lit.height, std::vector<int>(lit.red.size())};
  for (std::size_t i = 0; i < rise.light.size(); ++i) {
    rise.light[i] = std::max(0, lit.red[i] - dark.red[i]) +
                    std::max(0, lit.green[i] - dark.green[i]) +
                    std::max(0, lit.blue[i] - dark.blue[i]);
  }
  return rise;
}

double Brightest(const Rise& rise) {
  int most = 0;
  for (int y = 1; y + 1 < rise.height; ++y) {
    for (int x = 1; x + 1 < rise.width; ++x) {
      int sum = 0;
      for (int i = 0; i < 9; ++i) sum += rise.At(x - 1 + i % 3, y - 1 + i / 3);
      most = std::max(most, sum);
    }
  }
  return most / 9.0;
}

/// Connected quads above a threshold.
struct Spot {
  std::vector<std::pair<int, int>> quads;
  double light = 0;
  Eigen::Vector2d centre{0, 0};  // Weighted by light.
};

/// Takes the spot at a quad out of the rise.
Spot TakeSpot(Rise& rise, int x, int y, double threshold) {
  Spot spot;
  std::vector<std::pair<int, int>> open = {{x, y}};
  while (!open.empty()) {
    const auto [at_x, at_y] = open.back();
    open.pop_back();
    if (at_x < 0 || at_y < 0 || at_x >= rise.width || at_y >= rise.height) continue;
    int& light = rise.light[static_cast<std::size_t>(at_y * rise.width + at_x)];
    if (light < threshold) continue;
    spot.quads.emplace_back(at_x, at_y);
    spot.light += light;
    spot.centre += light * Eigen::Vector2d(at_x, at_y);
    light = 0;
    for (int i = 0; i < 9; ++i) open.emplace_back(at_x - 1 + i % 3, at_y - 1 + i / 3);
  }
  spot.centre /= std::max(1e-9, spot.light);
  return spot;
}

std::vector<Spot> SpotsOf(Rise rise, double threshold) {
  std::vector<Spot> spots;
  for (int y = 0; y < rise.height; ++y)
    for (int x = 0; x < rise.width; ++x)
      if (rise.At(x, y) >= threshold) spots.push_back(TakeSpot(rise, x, y, threshold));
  std::sort(spots.begin(), spots.end(),
            [](const Spot& a, const Spot& b) { return a.light > b.light; });
  return spots;
}

bool IsRound(const Spot& spot) {
  int left = spot.quads[0].first, right = left, top = spot.quads[0].second, bottom = top;
  for (const auto& [x, y] : spot.quads) {
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  const double width = right - left + 1, height = bottom - top + 1;
  // A quad more or less says nothing of a small spot.
  const double slack = 2 / std::min(width, height);
  return static_cast<double>(spot.quads.size()) >
             (kLeastFill - 0.2 * slack) * std::numbers::pi / 4 * width * height &&
         std::max(width, height) < (kMostAspect + slack) * std::min(width, height);
}

Blink Describe(const Spot& spot, const Image& image, const Quads& lit) {
  Blink blink;
  blink.centre_px = 2 * spot.centre + Eigen::Vector2d(0.5, 0.5);
  const double radius = std::sqrt(static_cast<double>(spot.quads.size()) / std::numbers::pi);
  blink.radius_px = 2 * radius;
  double count = 0, clipped = 0;
  for (const auto& [x, y] : spot.quads) {
    if ((Eigen::Vector2d(x, y) - spot.centre).norm() > std::max(0.8, 0.6 * radius)) continue;
    const auto at = static_cast<std::size_t>(y * lit.width + x);
    blink.colour_dn += Eigen::Vector3d(lit.red[at], lit.green[at], lit.blue[at]);
    for (int i = 0; i < 4; ++i)
      clipped += image.Value(2 * x + i % 2, 2 * y + i / 2) >= kLimitDn ? 0.25 : 0;
    ++count;
  }
  blink.colour_dn /= std::max(1.0, count);
  blink.clipped_share = clipped / std::max(1.0, count);
  return blink;
}

}  // namespace

void MeanImage::Add(const Image& image) {
  if (count_ == 0) sums_.assign(image.bytes.size(), 0);
  like_ = {image.format, image.width, image.height, {}};
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += image.bytes[i];
  ++count_;
}

Image MeanImage::View() {
  const auto count = static_cast<std::uint32_t>(count_);
  bytes_.resize(sums_.size());
  for (std::size_t i = 0; i < sums_.size(); ++i)
    bytes_[i] = static_cast<std::uint8_t>((sums_[i] + count / 2) / count);
  like_.bytes = bytes_;
  return like_;
}

Result<Blink> FindBlink(const Image& dark, const Image& lit) {
  Quads dark_quads, lit_quads;
  ToQuads(dark, dark_quads);
  ToQuads(lit, lit_quads);
  const Rise rise = RiseOf(dark_quads, lit_quads);
  const double brightest = Brightest(rise);
  if (brightest < kLeastRiseDn)
    return InvalidData(
        "nothing lights up when its sphere does: hold it in view of the camera, or raise the "
        "exposure");
  const std::vector<Spot> spots = SpotsOf(rise, std::max(kSpotShare * brightest, kLeastRiseDn / 2));
  if (spots.size() > 1 && spots[1].light > kRivalShare * spots[0].light)
    return InvalidData(
        "two places light up with its sphere: cover mirrors, keep still, and let no other light "
        "change");
  if (static_cast<int>(spots[0].quads.size()) < kLeastQuads)
    return InvalidData("its sphere is too small in the picture: come closer");
  if (!IsRound(spots[0]))
    return InvalidData(
        "what lights up is not round: hold the whole sphere in view, and keep still");
  return Describe(spots[0], lit, lit_quads);
}

}  // namespace footing::sphere
