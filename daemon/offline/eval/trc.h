#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "common/result/result.h"

namespace footing::eval {

/// Marker tracks of a TRC file in metres, by name, one place a frame.
struct MarkerTracks {
  double rate_hz = 0;
  std::size_t frames = 0;
  std::map<std::string, std::vector<Eigen::Vector3d>> markers;
};

/// An error names the line. Markers that are missing in a frame are errors: nothing is guessed.
Result<MarkerTracks> ReadTrc(const std::string& path);

}  // namespace footing::eval
