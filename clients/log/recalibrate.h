#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>

#include "common/base/result.h"

namespace footing::log_client {

struct RecalibrateReport {
  std::uint64_t messages = 0;  ///< Of the whole recording.
  std::uint64_t samples = 0;   ///< Of hands, turned into W again.
  std::uint64_t untouched =
      0;  ///< Of hands by trackers without a frame of their own, or another's.
};

/// Copies a recording, with the hands that this tracker saw where another calibration puts them:
/// what it saw in its own frame is in the recording. InvalidData when the recording is cut or has
/// no such hands; `output` is then left as it was.
Result<RecalibrateReport> Recalibrate(const std::string& input, const std::string& output,
                                      const std::string& tracker, const Eigen::Isometry3d& X_WC,
                                      const std::string& library, bool replace);

}  // namespace footing::log_client
