#pragma once

#include <string>

namespace footing::log_client {

inline constexpr int kSampleTicks = 300;  ///< 3 s at 100 Hz.

/// Writes the output of StreamRecorder for one synthetic session with "footingd": kSampleTicks
/// ticks, each with one motion sample of device 1; a status every 50 ticks; a gap of ticks 101 to
/// 105 behind tick 100; one attachment. Nothing in it depends on a clock.
void WriteSampleRecording(const std::string& path, bool simulated, bool compress = false);

}  // namespace footing::log_client
