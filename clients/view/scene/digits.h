#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace footing::scene {

/// A painted stroke: an axis-aligned rectangle, corners in letter heights; x to the right, y up.
struct Stroke {
  Eigen::Vector2f low;
  Eigen::Vector2f high;
};

/// Seven-segment digits of height 1 and width 0.55, centred on the origin. Only the characters 0 to
/// 9 are painted; others leave a gap.
std::vector<Stroke> PaintNumber(const std::string& digits);

}  // namespace footing::scene
