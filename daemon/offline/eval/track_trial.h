#pragma once

#include <optional>
#include <string>

#include "common/stream/user_interface.h"
#include "common/virtual/people/grip.h"
#include "daemon/offline/eval/statistics.h"
#include "daemon/offline/eval/gait_trial.h"
#include "daemon/offline/eval/agreement.h"
#include "daemon/offline/eval/jump_delays.h"
#include "daemon/offline/eval/jump_events.h"
#include "daemon/offline/eval/trace.h"

namespace footing::eval {

/// Who runs a trial, and with what.
struct TrackUser {
  /// None: the user's intention reaches the engine as a command, at once. Else by body, sensors,
  /// footingd's features and the interface.
  std::optional<stream::UserInterface> interface = {};
  /// How the remotes are rotated in the hands; none: as the user's style has it.
  std::optional<users::GripWish> grip = {};
  users::StyleWish style = {};
  std::string mapping_table = {};                          ///< Path; empty: the built-in one.
  stream::TurnSource turn_by = stream::TurnSource::kHead;  ///< Of the leg interface.
  std::uint64_t seed = 1;  ///< Of the user's style and noise, the task and the push.
  /// Ends after this time at the latest; without it a trial ends at the finish line.
  std::optional<double> seconds = {};
};

struct TrackResult {
  bool completed = false;  ///< Crossed the finish line.
  double time_s = 0;       ///< From the start line to there.
  double distance_m = 0;   ///< Along its way.
  double off_track_s = 0;  ///< Beside the track, but for falls.
  std::string task;        ///< The one that was drawn; empty: none.
  stream::FailureCounts failures;
  Agreement agreement;           ///< Of motion and command, but for falls; not of a direct user.
  JumpEvents jumps;              ///< The same, gesture by gesture.
  JumpDelays jump_delays;        ///< Where their time goes.
  RootMeanSquare heading_error;  ///< Body's yaw against the heading, rad, but for falls.
  RootMeanSquare line_heading;   ///< Body's yaw against the centre line, rad, but for falls.
  RootMeanSquare off_centre;     ///< COM's distance from the centre line, m.
};

/// One trial on a track, put back after each failure, kicked once by 2 N s. UsageError when the
/// track has no finish line and the user no `seconds`.
Result<TrackResult> RunTrack(const std::string& track, const TrackUser& user, TrackTrace& trace);

}  // namespace footing::eval
