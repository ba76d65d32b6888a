#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/view/scene/timeline.h"
#include "common/recording/seekable_recording.h"
#include "common/base/result.h"

namespace footing::view {

/// The servers of a recording that are shown, in the order of the default addresses.
const std::vector<std::string>& PlayedServers();
inline constexpr std::size_t kPlayedSimulation = 0;
inline constexpr std::size_t kPlayedSensors = 1;

/// Opens a recording for playback: those servers, with the channels that the viewer shows.
Result<playback::SeekableRecording> OpenForPlayback(const std::string& path);

/// What its events say: trials, failures, tasks, in seconds from its first tick; and when the gait
/// changed and what was last said, which a seek needs.
struct RecordedMarks {
  timeline::Timeline timeline;
  std::vector<std::int64_t> gait_changes_ns;  ///< By time, as the others.
  std::vector<std::int64_t> responses_ns;     ///< Of the ticks that brought one.
  std::vector<std::int64_t> notes_ns;         ///< Of the ticks that brought a text to read.
};

/// Reads all events once. InvalidData when there are more than the limits of timeline.h allow.
Result<RecordedMarks> ReadMarks(playback::SeekableRecording& recording);

}  // namespace footing::view
