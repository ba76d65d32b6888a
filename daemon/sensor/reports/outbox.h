#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "daemon/sensor/reports/output_report.h"

namespace footing::link {

/// Reports that wait to be written to one device: at most one per 10 ms, since devices choke on
/// more, and the one place that puts the rumble bit into every report.
class Outbox {
 public:
  static constexpr std::int64_t kIntervalNs = 10'000'000;
  static constexpr std::size_t kCapacity = 32;

  /// False when it is full.
  bool Push(reports::OutputReport report);
  /// Switches the motor; sends a report of its own when nothing else is waiting.
  void SetRumble(bool on);
  /// The next report to write now, if one is due.
  std::optional<reports::OutputReport> Next(std::int64_t now_ns);

  bool rumble() const { return rumble_; }

 private:
  std::deque<reports::OutputReport> waiting_;
  bool rumble_ = false;
  bool rumble_sent_ = false;
  bool written_ = false;
  std::int64_t written_ns_ = 0;
};

}  // namespace footing::link
