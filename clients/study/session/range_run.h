#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clients/study/plan/meter.h"
#include "clients/study/session/console.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "common/rig/follower.h"

namespace footing::study {

/// Channels of footingd that a measurement of ranges needs.
std::vector<std::string> RangeChannels();

/// Feeds the ticks of footingd to a meter of one rig's ranges.
class RangeFeed {
 public:
  /// `rig` empty: the first one with a device of the interface.
  RangeFeed(const ranges::Played& played, std::string rig);

  void Take(const rig::Tick& tick);
  const ranges::Meter& meter() const { return meter_; }
  const std::string& rig() const { return sensors_.rig(); }

 private:
  void TakeBoards(const rig::Tick& tick);

  ranges::Played played_;
  rig::Follower sensors_;
  struct Foot {
    board::FootLoad load;
    rig::LastHeard heard;  ///< On footingd's clock.
  };

  Foot left_, right_;
  ranges::Meter meter_;
};

/// Ranges measured in a recording.
struct RecordedRanges {
  ranges::Ranges ranges;
  bool simulated = false;
};
/// Ranges in a recording of footingd between two instants, in seconds from its start; `to_s` 0: to
/// its end. Errors as of RecordedSession and Meter::Measure.
Result<RecordedRanges> RangesInRecording(const std::string& path, const ranges::Played& played,
                                         const std::string& rig, double from_s, double to_s);

/// Prompts a person through the motions of an interface, in about 20 s (boards: 33 s), and measures
/// them live: NoDevice before the first prompt when footingd or a device is not there, a failure
/// with the motion to repeat when one was too small or too short.
Result<RecordedRanges> MeasureRanges(Console& console, const transport::Address& sensor,
                                     const std::string& rig, const ranges::Played& played);

}  // namespace footing::study
