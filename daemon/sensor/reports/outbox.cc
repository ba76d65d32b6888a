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

std::optional<reports::OutputReport> Outbox::Next(std::int64_t now_ns) {
  if (written_ && now_ns - written_ns_ < kIntervalNs) return std::nullopt;
  reports::OutputReport report;
  if (!waiting_.empty()) {
    report = std::move(waiting_.front());
    waiting_.pop_front();
  } else if (rumble_ != rumble_sent_) {
    report = reports::RumbleOnly();
  } else {
    return std::nullopt;
  }
  reports::SetRumbleBit(report, rumble_);
  rumble_sent_ = rumble_;
  written_ = true;
  written_ns_ = now_ns;
  return report;
}

}  // namespace footing::link
