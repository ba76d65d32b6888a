#pragma once

#include <array>
#include <string>

#include "daemon/offline/eval/gait/statistics.h"
#include "daemon/offline/eval/gait/trial.h"

namespace footing::eval {

/// How the synthetic user's commands reach the engine.
enum class Interface {
  kDirect,  ///< As a GaitCommand, at once.
  kWrist,   ///< By two swung controllers, footingd's features and the wrist mapping.
};

struct TrackResult {
  bool completed = false;         ///< Reached the finish, 3 m before the end and at most 100 m on.
  double time_s = 0;              ///< From the start to there.
  std::array<int, 3> failures{};  ///< By engine::FailureCause.
  RootMeanSquare heading_error;   ///< Body's yaw against the heading, rad, but for falls.
  RootMeanSquare off_centre;      ///< COM's distance from the centre line, m.
};

/// One run along a track, put back after each failure, kicked once by 2 N s.
Result<TrackResult> RunTrack(const std::string& track, Interface interface, std::uint64_t seed);

}  // namespace footing::eval
