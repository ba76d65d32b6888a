#include "daemon/sensor/reports/keep_alive.h"

#include <algorithm>

#include "common/base/units.h"
namespace footing::handshake {

void KeepAlive::TakeData(std::int64_t now_ns) {
  data_ns_ = now_ns;
  wait_s_ = config_.reassert_min_s;
}

void KeepAlive::TakeStatus(std::int64_t now_ns) {
  if (first_due_ || !after_status_.Take(now_ns)) return;
  first_due_ = true;
  first_ns_ = now_ns + SecondsToNanoseconds(config_.after_status_s);
  second_due_ = true;
  second_ns_ = now_ns + SecondsToNanoseconds(config_.second_try_s);
}

KeepAlive::Action KeepAlive::SetMode() {
  ++reasserts_;
  return Action::kSetMode;
}

KeepAlive::Action KeepAlive::Advance(std::int64_t now_ns) {
  if (first_due_ && now_ns >= first_ns_) {
    first_due_ = false;
    return SetMode();
  }
  if (second_due_ && now_ns >= second_ns_) {
    second_due_ = false;
    // Data that came earlier may be the last before the driver's own mode took hold.
    if (SilenceS(now_ns) < config_.second_try_s / 2) return Action::kNone;
    next_ns_ = now_ns + SecondsToNanoseconds(std::max(wait_s_, config_.reassert_min_s));
    return SetMode();
  }
  const double silence_s = SilenceS(now_ns);
  if (silence_s < config_.silence_s || now_ns < next_ns_) return Action::kNone;
  if (silence_s >= config_.ask_after_s &&
      now_ns - asked_ns_ >= SecondsToNanoseconds(config_.ask_after_s)) {
    asked_ns_ = now_ns;
    return Action::kAskStatus;
  }
  wait_s_ = std::clamp(wait_s_, config_.reassert_min_s, config_.reassert_max_s);
  next_ns_ = now_ns + SecondsToNanoseconds(wait_s_);
  wait_s_ *= 2;
  return SetMode();
}

}  // namespace footing::handshake
