#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "daemon/sensor/reports/output_report.h"

namespace footing::link {

/// How a kind of device is written to; the defaults are a Wiimote's.
struct Writing {
  std::int64_t interval_ns = 10'000'000;         ///< Least time between two reports,
  std::int64_t rumble_interval_ns = 10'000'000;  ///< and before one for the motor alone.
  std::int64_t rumble_repeat_ns = 0;             ///< Interval of the motor's repeats; 0: none.
  reports::OutputReport (*rumble_only)() = reports::RumbleOnly;
  void (*set_rumble)(reports::OutputReport& report, bool on) = reports::SetRumbleBit;
};

/// Reports that wait to be written to one device: at most one per interval, since devices choke on
/// more, and the one place that puts the motor's state into every report.
class Outbox {
 public:
  static constexpr std::size_t kCapacity = 32;

  explicit Outbox(const Writing& writing = {}) : writing_(writing) {}

  /// False when it is full.
  bool Push(reports::OutputReport report);
  /// Switches the motor; sends a report of its own when nothing else is waiting.
  void SetRumble(bool on);
  /// The next report to write now, if one is due.
  std::optional<reports::OutputReport> Next(std::int64_t now_ns);

  bool rumble() const { return rumble_; }

 private:
  bool RumbleIsDue(std::int64_t since_ns) const;

  Writing writing_;
  std::deque<reports::OutputReport> waiting_;
  bool rumble_ = false;
  bool rumble_sent_ = false;
  bool written_ = false;
  std::int64_t written_ns_ = 0;
};

}  // namespace footing::link
