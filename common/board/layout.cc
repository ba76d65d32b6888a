#include "common/board/layout.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/board/geometry.h"

namespace footing::board {
namespace {

constexpr double kFarthestM = 5;
constexpr double kLargestYawRad = 6.3;
constexpr double kQuarterRad = 0.5 * kPi;
constexpr double kGapToleranceMm = 2;  // The gap is measured with a ruler, poses are worked out.

std::string WholeNumber(double value) { return std::to_string(std::lround(value)); }

bool Sound(const stream::BoardPose& pose) {
  return std::abs(pose.x_m) <= kFarthestM && std::abs(pose.y_m) <= kFarthestM &&
         std::abs(pose.yaw_rad) <= kLargestYawRad;  // False for NaN, too.
}

/// Half the extent of a board along the direction (cos a, sin a) of W.
double HalfExtentM(const stream::BoardPose& pose, double direction_rad) {
  const double off_front_rad = direction_rad - pose.yaw_rad;
  return 0.5 * (kBalanceBoard.plate_y_m * std::abs(std::cos(off_front_rad)) +
                kBalanceBoard.plate_x_m * std::abs(std::sin(off_front_rad)));
}

}  // namespace

std::array<stream::BoardPose, 2> OneFootEach(double gap_m) {
  const double middle_m = 0.5 * (kBalanceBoard.plate_y_m + gap_m);
  return {stream::BoardPose{0, middle_m, -kQuarterRad},
          stream::BoardPose{0, -middle_m, kQuarterRad}};
}

std::optional<stream::BoardLayout> LayoutNamed(const std::string& preset, double gap_mm) {
  stream::BoardLayout layout;
  layout.preset = preset;
  layout.gap_mm = gap_mm;
  if (preset == "one_foot_each") {
    const auto poses = OneFootEach(gap_mm * 1e-3);
    layout.left = poses[0];
    layout.right = poses[1];
  } else if (preset == "side_by_side") {
    layout.left.y_m = 0.5 * (kBalanceBoard.plate_x_m + gap_mm * 1e-3);
    layout.right.y_m = -layout.left.y_m;
  } else if (preset == "single") {
    layout.gap_mm = 0;
  } else {
    return std::nullopt;
  }
  return layout;
}

stream::BoardLayout DefaultLayout() { return *LayoutNamed("one_foot_each", kUsualGapMm); }

stream::BoardLayout LayoutOr(const stream::BoardLayout& published) {
  if (!published.preset.empty()) return published;
  stream::BoardLayout layout = DefaultLayout();
  layout.rig = published.rig;
  layout.left_geometry = published.left_geometry;
  layout.right_geometry = published.right_geometry;
  return layout;
}

double GapM(const stream::BoardPose& left, const stream::BoardPose& right) {
  double widest_m = -kFarthestM;
  for (const double direction_rad :
       {left.yaw_rad, left.yaw_rad + kQuarterRad, right.yaw_rad, right.yaw_rad + kQuarterRad}) {
    const double centres_m = std::abs((right.x_m - left.x_m) * std::cos(direction_rad) +
                                      (right.y_m - left.y_m) * std::sin(direction_rad));
    widest_m = std::max(
        widest_m, centres_m - HalfExtentM(left, direction_rad) - HalfExtentM(right, direction_rad));
  }
  return widest_m;
}

std::string ProblemWith(const stream::BoardLayout& layout, std::size_t boards,
                        const std::string& rig) {
  if (layout.preset != "single" || boards < 2) return "";
  return "the layout single is for one board, but rig " + rig + " has " + std::to_string(boards) +
         ": footing-ctl layout --rig " + rig +
         " --preset one_foot_each (or side_by_side), or switch the other board off";
}

std::string Problem(const stream::BoardLayout& layout) {
  static constexpr const char* kPresets[] = {"one_foot_each", "side_by_side", "single", "custom"};
  if (std::find(std::begin(kPresets), std::end(kPresets), layout.preset) == std::end(kPresets)) {
    return "layout \"" + layout.preset.substr(0, 32) +
           "\" does not exist; there are one_foot_each, side_by_side, single, custom";
  }
  const bool single = layout.preset == "single";
  if (!Sound(layout.left) || (!single && !Sound(layout.right))) {
    return "a board's pose is not a place within 5 m and a turn within +-6.28 rad";
  }
  if (single) return "";
  if (!(layout.gap_mm >= 0 && layout.gap_mm <= 2 * kFarthestM * 1e3)) {
    return "gap_mm must be 0 or more: the distance between the boards' facing edges";
  }
  if (layout.left.y_m <= layout.right.y_m) {
    return "the left board lies right of the right one (y is to the left); exchange the poses";
  }
  const double gap_mm = GapM(layout.left, layout.right) * 1e3;
  if (gap_mm < -kGapToleranceMm) {
    return "the boards overlap by " + WholeNumber(-gap_mm) + " mm (each is " +
           WholeNumber(kBalanceBoard.plate_x_m * 1e3) + " x " +
           WholeNumber(kBalanceBoard.plate_y_m * 1e3) + " mm); move their poses apart";
  }
  if (std::abs(gap_mm - layout.gap_mm) > kGapToleranceMm) {
    return "gap_mm is " + WholeNumber(layout.gap_mm) + ", but the poses leave " +
           WholeNumber(gap_mm) + " mm; measure between the facing edges and make them agree";
  }
  return "";
}

}  // namespace footing::board
