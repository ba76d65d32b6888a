#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/base/result.h"
#include "common/camera/image.h"
#include "common/camera/lens.h"

namespace footing::lens_calibration {

/// One dot of a printed sheet: its column and row, counted from some dot, and where it appears.
struct GridDot {
  Eigen::Vector2i at{0, 0};
  Eigen::Vector2d pixel{0, 0};
};

/// The dots of a sheet in a frame: dark round spots on white, in columns and rows of one pitch.
/// Part of the sheet is enough. Fewer than `kLeastDots` are none at all.
std::vector<GridDot> FindDotGrid(const sphere::Image& image);

inline constexpr std::size_t kLeastDots = 20;

using View = std::vector<GridDot>;

/// A fitted lens and how well it is known.
struct LensFit {
  sphere::Lens lens;
  double rms_px = 0;       ///< RMS of a dot's two coordinates together.
  double largest_px = 0;   ///< The worst dot.
  double focal_sd_px = 0;  ///< Standard deviation of fx and fy, the larger one.
  double centre_sd_px = 0;
  double covered = 0;  ///< Share of the image, in 8 x 6 parts, that has a dot in some view.
};

/// Share of the image, in 8 x 6 parts, in which some view has a dot.
double Covered(const std::vector<View>& views, int width, int height);

/// Focal lengths, principal point, k1, k2, p1 and p2 from views of one flat sheet, whose pitch does
/// not matter (Zhang, A flexible new technique for camera calibration, 2000, with square pixels at
/// the start). InvalidData says what is wrong with the views: fewer than six, all of them parallel
/// to the sensor, a residual above 0.5 px, or parts of the image without dots.
Result<LensFit> FitLens(const std::vector<View>& views, int width, int height);

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
  /// Next action for the person, with the progress so far.
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
