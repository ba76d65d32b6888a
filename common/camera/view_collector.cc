#include "common/camera/view_collector.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace footing::lens_calibration {
namespace {

constexpr double kNew = 0.025;    // Of the image's width, in one of six numbers.
constexpr double kRests = 0.001;  // From one frame to the next.
constexpr double kEnoughCovered = 0.75;

}  // namespace

ViewCollector::Shape ViewCollector::ShapeOf(const View& view, int width) {
  const auto count = static_cast<double>(view.size());
  Eigen::Vector2d mean(0, 0);
  for (const GridDot& dot : view) mean += dot.pixel / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  // Perspective makes one side smaller: the third moments.
  Eigen::Vector2d skew(0, 0);
  for (const GridDot& dot : view) {
    const Eigen::Vector2d from = dot.pixel - mean;
    spread += from * from.transpose() / count;
    skew += from.cwiseAbs2().cwiseProduct(from) / count;
  }
  Shape shape;
  shape << mean, std::sqrt(spread(0, 0)), std::sqrt(spread(1, 1)), std::cbrt(skew.x()),
      std::cbrt(skew.y());
  return shape / width;
}

bool ViewCollector::Take(const sphere::Image& image) {
  width_ = image.width;
  height_ = image.height;
  View view = FindDotGrid(image);
  if (view.empty()) {
    last_.reset();
    return false;
  }
  const Shape shape = ShapeOf(view, image.width);
  const std::optional<Shape> before = std::exchange(last_, shape);
  const auto apart = [&shape](const Shape& other) { return (shape - other).cwiseAbs().maxCoeff(); };
  if (needs_rest_ && (!before || apart(*before) > kRests)) return false;
  const bool is_known = std::any_of(shapes_.begin(), shapes_.end(),
                                    [&](const Shape& other) { return apart(other) < kNew; });
  if (is_known) return false;
  views_.push_back(std::move(view));
  shapes_.push_back(shape);
  return true;
}

bool ViewCollector::is_complete() const {
  return static_cast<int>(views_.size()) >= wanted_ &&
         Covered(views_, width_, height_) >= kEnoughCovered;
}

std::string ViewCollector::Advice() const {
  const std::string count =
      "view " + std::to_string(views_.size()) + " of " + std::to_string(wanted_) + ": ";
  if (!last_) return count + "hold the sheet of dots before the camera, well lit and flat";
  if (static_cast<int>(views_.size()) < wanted_)
    return count + "move the sheet elsewhere, tilt it another way, and keep it still";
  const auto covered = std::lround(100 * Covered(views_, width_, height_));
  return count + "bring the sheet to the picture's edges and corners (" + std::to_string(covered) +
         " % are covered)";
}

}  // namespace footing::lens_calibration
