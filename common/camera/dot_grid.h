#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/camera/image.h"

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

}  // namespace footing::lens_calibration
