#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::eval {

/// Rows `ax,ay,az` in m/s² of the sensor frame S; a first line that is not numbers is a header. An
/// error names the line.
Result<std::vector<Eigen::Vector3d>> ReadAccelerationCsv(const std::string& path);

/// Axes (bits 0, 1, 2) of every row that are at the end of the sensor's range. `range_mps2` > 0: at
/// or beyond it. 0: unknown, then it is where an axis stays at its largest value for three rows,
/// above 2.9 g.
std::vector<std::uint32_t> ClippedAxes(const std::vector<Eigen::Vector3d>& rows, double range_mps2);

/// A recording of the Gesture Recognition Toolkit: stretches (class numbers) of accelerations
/// between 0 and 1 without unit or rate.
struct GrtRecording {
  struct Row {
    int stretch = 0;
    Eigen::Vector3d specific_force_mps2 = Eigen::Vector3d::Zero();
  };
  std::vector<Row> rows;
  /// The middle of the range counts as 0; the median length of the quieter half of the rows as 1 g.
  double mps2_per_unit = 0;
};
Result<GrtRecording> ReadGrt(const std::string& path);

}  // namespace footing::eval
