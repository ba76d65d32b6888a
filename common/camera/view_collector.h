#pragma once

#include <optional>
#include <string>

#include "common/camera/fit_lens.h"

namespace footing::lens_calibration {

/// Chooses frames of a sheet of dots that a person moves before the camera: each must differ from
/// those that it has, and with `needs_rest` the sheet must rest, since an image row is exposed
/// later than the one above.
class ViewCollector {
 public:
  ViewCollector(int wanted, bool needs_rest) : wanted_(wanted), needs_rest_(needs_rest) {}

  /// True when the frame has become a view.
  bool Take(const sphere::Image& image);
  bool is_complete() const;
  const std::vector<View>& views() const { return views_; }
  /// What the person should do now, with how far it is.
  std::string Advice() const;

 private:
  /// Where a view's dots are and how they spread, over the image's width.
  using Shape = Eigen::Matrix<double, 6, 1>;
  static Shape ShapeOf(const View& view, int width);

  int wanted_;
  bool needs_rest_;
  int width_ = 0, height_ = 0;
  std::vector<View> views_;
  std::vector<Shape> shapes_;
  std::optional<Shape> last_;
};

}  // namespace footing::lens_calibration
