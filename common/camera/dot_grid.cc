#include "common/camera/dot_grid.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <utility>

namespace footing::lens_calibration {
namespace {

constexpr double kDarkShare = 0.75;  // Of the mean around, to which the dots belong too.
constexpr int kWindowShare = 8;      // The mean is of this part of the width.
constexpr std::size_t kLeastPixels = 12, kMostPixels = 6000;
constexpr double kLeastFill = 0.75, kMostFill = 1.2, kMostAspect = 2.5;
constexpr double kMostAreaRatio = 2.5;   // Of neighbours.
constexpr double kOffPrediction = 0.35;  // Of the step.

/// Light of every 2 x 2 pixels, which a mosaic mixes alike everywhere; its pixel (0, 0) is at
/// (0.5, 0.5) of the image.
class Grey {
 public:
  explicit Grey(const sphere::Image& image) : width_(image.width - 1), height_(image.height - 1) {
    light_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
    for (int v = 0; v < height_; ++v)
      for (int u = 0; u < width_; ++u)
        light_.push_back(image.Value(u, v) + image.Value(u + 1, v) + image.Value(u, v + 1) +
                         image.Value(u + 1, v + 1));
    Sum();
  }

  int width() const { return width_; }
  int height() const { return height_; }
  bool Has(int u, int v) const { return u >= 0 && v >= 0 && u < width_ && v < height_; }
  int At(int u, int v) const { return light_[Index(u, v)]; }
  bool IsDark(int u, int v) const {
    const int half = width_ / kWindowShare / 2;
    const int u0 = std::max(0, u - half), v0 = std::max(0, v - half);
    const int u1 = std::min(width_, u + half + 1), v1 = std::min(height_, v + half + 1);
    const double sum = SumTo(u1, v1) - SumTo(u0, v1) - SumTo(u1, v0) + SumTo(u0, v0);
    return At(u, v) < kDarkShare * sum / ((u1 - u0) * (v1 - v0));
  }

 private:
  std::size_t Index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(u);
  }
  /// Of all pixels above and left of a corner.
  double SumTo(int u, int v) const {
    return sums_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_ + 1) +
                 static_cast<std::size_t>(u)];
  }
  void Sum() {
    const auto row = static_cast<std::size_t>(width_ + 1);
    sums_.assign(row * static_cast<std::size_t>(height_ + 1), 0);
    for (int v = 0; v < height_; ++v) {
      double line = 0;
      for (int u = 0; u < width_; ++u) {
        line += At(u, v);
        const auto at = static_cast<std::size_t>(v + 1) * row + static_cast<std::size_t>(u + 1);
        sums_[at] = sums_[at - row] + line;
      }
    }
  }

  int width_, height_;
  std::vector<int> light_;
  std::vector<double> sums_;
};

struct Spot {
  Eigen::Vector2d centre{0, 0};  // In the grey image.
  double area = 0;
};

/// Middle of the darkness in and around a box, less than what is around the spot.
Eigen::Vector2d MiddleOf(const Grey& grey, int left, int top, int right, int bottom) {
  constexpr int kMargin = 3;
  std::vector<int> around;
  for (int v = top - kMargin; v <= bottom + kMargin; ++v)
    for (int u = left - kMargin; u <= right + kMargin; ++u)
      if (grey.Has(u, v) && (u < left - 1 || u > right + 1 || v < top - 1 || v > bottom + 1))
        around.push_back(grey.At(u, v));
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::nth_element(around.begin(), middle, around.end());
  // Noise of the paper is not darkness.
  const double white = 0.93 * *middle;
  double sum = 0;
  Eigen::Vector2d at(0, 0);
  for (int v = top - kMargin; v <= bottom + kMargin; ++v) {
    for (int u = left - kMargin; u <= right + kMargin; ++u) {
      if (!grey.Has(u, v)) continue;
      const double dark = std::max(0.0, white - grey.At(u, v));
      sum += dark;
      at += dark * Eigen::Vector2d(u, v);
    }
  }
  return at / std::max(1e-9, sum);
}

/// Dark connected pixels from one on; `is_open` are those that no spot has yet.
std::optional<Spot> TakeSpot(const Grey& grey, int u, int v, std::vector<bool>& is_open) {
  const auto index = [&grey](int at_u, int at_v) {
    return static_cast<std::size_t>(at_v) * static_cast<std::size_t>(grey.width()) +
           static_cast<std::size_t>(at_u);
  };
  int left = u, right = u, top = v, bottom = v;
  std::size_t pixels = 0;
  std::vector<std::pair<int, int>> waiting = {{u, v}};
  is_open[index(u, v)] = false;
  while (!waiting.empty()) {
    const auto [at_u, at_v] = waiting.back();
    waiting.pop_back();
    ++pixels;
    left = std::min(left, at_u);
    right = std::max(right, at_u);
    top = std::min(top, at_v);
    bottom = std::max(bottom, at_v);
    for (const auto& [du, dv] :
         {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
      if (!grey.Has(at_u + du, at_v + dv) || !is_open[index(at_u + du, at_v + dv)]) continue;
      is_open[index(at_u + du, at_v + dv)] = false;
      waiting.emplace_back(at_u + du, at_v + dv);
    }
  }
  const bool is_cut = left < 2 || top < 2 || right > grey.width() - 3 || bottom > grey.height() - 3;
  const double width = right - left + 1, height = bottom - top + 1;
  const double fill = static_cast<double>(pixels) / (std::numbers::pi / 4 * width * height);
  if (is_cut || pixels < kLeastPixels || pixels > kMostPixels || fill < kLeastFill ||
      fill > kMostFill || std::max(width, height) > kMostAspect * std::min(width, height))
    return std::nullopt;
  return Spot{MiddleOf(grey, left, top, right, bottom), static_cast<double>(pixels)};
}

std::vector<Spot> SpotsOf(const Grey& grey) {
  std::vector<bool> is_open;
  for (int v = 0; v < grey.height(); ++v)
    for (int u = 0; u < grey.width(); ++u) is_open.push_back(grey.IsDark(u, v));
  std::vector<Spot> spots;
  std::size_t at = 0;
  for (int v = 0; v < grey.height(); ++v) {
    for (int u = 0; u < grey.width(); ++u, ++at) {
      if (!is_open[at]) continue;
      if (const auto spot = TakeSpot(grey, u, v, is_open)) spots.push_back(*spot);
    }
  }
  return spots;
}

/// The steps of the grid at a dot, px: along a row and along a column.
struct Steps {
  Eigen::Vector2d along, down;
};

bool AreAlike(const Spot& a, const Spot& b) {
  return std::max(a.area, b.area) < kMostAreaRatio * std::min(a.area, b.area);
}

/// The nearest neighbour, and the nearest one across.
std::optional<Steps> StepsAt(const std::vector<Spot>& spots, std::size_t from) {
  std::optional<Eigen::Vector2d> along, down;
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < spots.size(); ++i) {
      if (i == from || !AreAlike(spots[i], spots[from])) continue;
      const Eigen::Vector2d step = spots[i].centre - spots[from].centre;
      if (pass == 0 && (!along || step.norm() < along->norm())) along = step;
      if (pass == 0 || !along) continue;
      const double cosine = std::abs(step.normalized().dot(along->normalized()));
      if (cosine < 0.6 && (!down || step.norm() < down->norm())) down = step;
    }
  }
  if (!along || !down || down->norm() > 2.5 * along->norm()) return std::nullopt;
  return Steps{*along, *down};
}

/// Follows the grid from one spot on, step by step.
std::vector<GridDot> GrowFrom(const std::vector<Spot>& spots, std::size_t first) {
  const auto steps = StepsAt(spots, first);
  if (!steps) return {};
  struct Node {
    std::size_t spot;
    Eigen::Vector2i at;
    Steps steps;
  };
  std::vector<bool> is_taken(spots.size());
  std::deque<Node> open = {{first, {0, 0}, *steps}};
  is_taken[first] = true;
  std::vector<GridDot> dots;
  while (!open.empty()) {
    const Node node = open.front();
    open.pop_front();
    dots.push_back({node.at, spots[node.spot].centre + Eigen::Vector2d(0.5, 0.5)});
    for (const Eigen::Vector2i& way : {Eigen::Vector2i(1, 0), Eigen::Vector2i(-1, 0),
                                       Eigen::Vector2i(0, 1), Eigen::Vector2i(0, -1)}) {
      const Eigen::Vector2d step = way.x() * node.steps.along + way.y() * node.steps.down;
      const Eigen::Vector2d expected = spots[node.spot].centre + step;
      std::size_t nearest = spots.size();
      double least = kOffPrediction * step.norm();
      for (std::size_t i = 0; i < spots.size(); ++i) {
        const double off = (spots[i].centre - expected).norm();
        if (is_taken[i] || off >= least || !AreAlike(spots[i], spots[node.spot])) continue;
        least = off;
        nearest = i;
      }
      if (nearest == spots.size()) continue;
      is_taken[nearest] = true;
      Node next{nearest, node.at + way, node.steps};
      const Eigen::Vector2d seen = spots[nearest].centre - spots[node.spot].centre;
      (way.y() == 0 ? next.steps.along : next.steps.down) = (way.x() + way.y()) * seen;
      open.push_back(next);
    }
  }
  return dots;
}

}  // namespace

std::vector<GridDot> FindDotGrid(const sphere::Image& image) {
  const std::vector<Spot> spots = SpotsOf(Grey(image));
  // Things on the table are spots too: the largest grid counts.
  std::vector<GridDot> largest;
  for (std::size_t first = 0; first < spots.size(); first += 1 + spots.size() / 12) {
    std::vector<GridDot> dots = GrowFrom(spots, first);
    if (dots.size() > largest.size()) largest = std::move(dots);
  }
  return largest.size() < kLeastDots ? std::vector<GridDot>() : largest;
}

}  // namespace footing::lens_calibration
