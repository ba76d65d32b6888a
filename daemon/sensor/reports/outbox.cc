#include "daemon/sensor/reports/outbox.h"

#include <utility>

namespace footing::link {
namespace {

constexpr std::uint8_t kLeds = 0x11;

}  // namespace

bool Outbox::Push(reports::OutputReport report) {
  // Only the newest report for the LEDs counts: it takes the place of one that waits.
  for (reports::OutputReport& one : waiting_) {
    if (report.empty() || one.empty() || report[0] != kLeds || one[0] != kLeds) continue;
    one = std::move(report);
    return true;
  }
  if (waiting_.size() >= kCapacity) {
    return false;
  }
  waiting_.push_back(std::move(report));
  return true;
}

void Outbox::SetRumble(bool on) { rumble_ = on; }

bool Outbox::RumbleIsDue(std::int64_t since_ns) const {
  if (written_ && since_ns < writing_.rumble_interval_ns) return false;
  const bool repeats = rumble_ && writing_.rumble_repeat_ns > 0;
  return rumble_ != rumble_sent_ || (repeats && since_ns >= writing_.rumble_repeat_ns);
}

std::optional<reports::OutputReport> Outbox::Next(std::int64_t now_ns) {
  const std::int64_t since_ns = now_ns - written_ns_;
  if (written_ && since_ns < writing_.interval_ns) return std::nullopt;
  reports::OutputReport report;
  if (!waiting_.empty()) {
    report = std::move(waiting_.front());
    waiting_.pop_front();
  } else if (RumbleIsDue(since_ns)) {
    report = writing_.rumble_only();
  } else {
    return std::nullopt;
  }
  writing_.set_rumble(report, rumble_);
  rumble_sent_ = rumble_;
  written_ = true;
  written_ns_ = now_ns;
  return report;
}

}  // namespace footing::link
