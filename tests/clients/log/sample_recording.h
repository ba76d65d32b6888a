#pragma once

#include <string>

namespace footing::log_client {

inline constexpr int kSampleTicks = 300;  ///< 3 s at 100 Hz.

/// Writes the output of StreamRecorder for one synthetic session with "footingd": kSampleTicks
/// ticks, each with one motion sample of device 1; a status every 50 ticks; a gap of ticks 101 to
/// 105 behind tick 100; one attachment. Nothing in it depends on a clock.
void WriteSampleRecording(const std::string& path, bool simulated, bool compress = false);

/// A scene for drawing: 1 s at 100 Hz of a "person" of three links that moves ahead, on two boards
/// of which the left one carries 500 N at its middle, with a track of two segments and a pit
/// between them; two markers in one tick of footingd, and a fall in footing-sim. The first tick of
/// footing-sim is a snapshot, later than the next one.
void WriteSceneRecording(const std::string& path);

}  // namespace footing::log_client
