#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "clients/study/plan/meter.h"
#include "clients/study/session/console.h"
#include "common/base/result.h"
#include "common/net/address.h"
#include "footing/v1/session.pb.h"

namespace footing::study {

/// Channels of footingd that a measurement of ranges needs.
std::vector<std::string> RangeChannels();

/// Feeds the ticks of footingd to a meter of one rig's ranges.
class RangeFeed {
 public:
  /// `rig` empty: the first one with a device of the interface.
  RangeFeed(const ranges::Played& played, std::string rig);

  void Take(const v1::Tick& tick);
  const ranges::Meter& meter() const { return meter_; }
  const std::string& rig() const { return rig_; }

 private:
  struct Device {
    std::string rig;
    stream::DeviceRole role = stream::DeviceRole::kUnspecified;
    bool mounted = false;
  };

  bool Follows(const std::string& rig, stream::DeviceRole role);
  void TakeStatus(const v1::DeviceStatusList& status);
  void TakeStick(double time_s, const v1::NunchukSamples& samples);
  void TakeBoards(double time_s, const v1::BoardSamples& samples);

  ranges::Played played_;
  std::string rig_;
  struct Foot {
    board::FootLoad load;
    double seen_s = -1;  ///< When its board last sent; negative: not yet.
    bool simulated = false;
  };

  std::map<std::uint32_t, Device> devices_;
  v1::SetupState setup_;
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
