#pragma once

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
  bool completed = false;  ///< Crossed the finish line.
  double time_s = 0;       ///< From the start line to there.
  std::string task;        ///< The one that was drawn; empty: none.
  stream::FailureCounts failures;
  RootMeanSquare heading_error;  ///< Body's yaw against the heading, rad, but for falls.
  RootMeanSquare line_heading;   ///< Body's yaw against the centre line, rad, but for falls.
  RootMeanSquare off_centre;     ///< COM's distance from the centre line, m.
};

/// One trial on a track, put back after each failure, kicked once by 2 N s. The seed draws the
/// task. UsageError when the track has no finish line.
Result<TrackResult> RunTrack(const std::string& track, Interface interface, std::uint64_t seed);

}  // namespace footing::eval
