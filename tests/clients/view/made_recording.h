#pragma once

#include <cstdint>
#include <string>

/// A recording of both servers of the made stream, at 100 Hz.
///
/// It runs, and walks from 20 s on. Trial p07-1 is ready at 5 s, starts at 6 s and finishes at 50
/// s; failures at 30 s (curve; put back 5 m at 30.3 s) and at 42 s (jump; withdrawn at 43 s); its
/// task is done at 35 s. A second trial, p07-2, is ready at 55 s and never starts.
namespace footing::view::made {

struct RecordingWish {
  double seconds = 60;
  double sensors_until_s = 1e9;  ///< Then footingd sends nothing more.
  double frames_until_s = 1e9;   ///< Then footing-sim sends nothing more.
  bool trials = true;
};

/// Time of the first tick.
inline constexpr std::int64_t kFirstNs = 1'000'000'000'000;

void WriteRecording(const std::string& path, const RecordingWish& wish);

}  // namespace footing::view::made
