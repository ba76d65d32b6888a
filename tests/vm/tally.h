#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "footing/v1/session.pb.h"
#include "tests/vm/ramp.h"

namespace footing::vm {

/// Samples of each device that reached a subscribed client, between two instants of `received_ns`.
class Tally {
 public:
  void TakeTick(const v1::Tick& tick, std::int64_t now_ns);
  void TakeGap() { ++gaps_; }

  /// Samples received in begin..end count, the end excluded; before that none does.
  void CountBetween(std::int64_t begin_ns, std::int64_t end_ns);
  int Live() const;  ///< Devices, as of the newest status.
  nlohmann::json Summary() const;

 private:
  struct One {
    v1::DeviceStatus status;
    std::uint64_t samples = 0;
    std::uint64_t missing = 0;  ///< By the ramp.
    std::uint64_t twice = 0;    ///< By the ramp.
    std::uint64_t foreign = 0;  ///< Not of the ramp at all.
    std::uint64_t nunchuk_samples = 0;
    std::uint64_t turning_samples = 0;  ///< With an angular velocity.
    int last_step = -1;
    std::uint64_t last_report_count = 0;  ///< Report count of this device since it attached.
    std::int64_t last_received_ns = 0;
    std::int64_t longest_silence_ns = 0;
    /// When this client had the first sample, and the first after each silence.
    std::vector<std::int64_t> resumed_ns;
    std::vector<std::string> places;  ///< Nodes, in the order of their use.
  };

  void TakeSample(One& one, const Ramp& ramp, double value, std::uint64_t report_count,
                  std::int64_t received_ns, std::int64_t now_ns);

  std::map<std::uint32_t, One> devices_;
  std::uint64_t gaps_ = 0;
  std::uint64_t ticks_ = 0;
  std::int64_t begin_ns_ = INT64_MAX;
  std::int64_t end_ns_ = INT64_MAX;
};

}  // namespace footing::vm
