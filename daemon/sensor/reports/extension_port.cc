#include "daemon/sensor/reports/extension_port.h"

#include <algorithm>

namespace footing::handshake {
namespace {

constexpr std::int64_t kSenselessNs = 1'000'000'000;  // Bytes without sense for longer: check.
constexpr std::int64_t kQuietNs = 10'000'000'000;     // Settled for longer: checked at once.

}  // namespace

void PortCheck::Request(std::int64_t now_ns) {
  if (requested_) return;
  if (now_ns - done_ns_ > kQuietNs) wait_s_ = 0;
  requested_ = true;
  due_ns_ = now_ns + static_cast<std::int64_t>(std::max(wait_s_, config_.settle_s) * 1e9);
  wait_s_ = std::clamp(2 * wait_s_, config_.min_s, config_.max_s);
}

bool PortCheck::Take(std::int64_t now_ns) {
  if (!requested_ || now_ns < due_ns_) return false;
  requested_ = false;
  return true;
}

void ExtensionPort::StartOver() {
  ready_ = false;
  identity_tries_ = 0;
}

void ExtensionPort::Disturb(std::int64_t until_ns) {
  disturbed_until_ns_ = until_ns;
  ready_ = false;
}

void ExtensionPort::BecomeReady(std::int64_t now_ns) {
  if (ready_) return;
  ready_ = true;
  ++epoch_;
  sense_ns_ = now_ns;
}

void ExtensionPort::Publish(stream::Extension extension) {
  if (published_ != stream::Extension::kUnspecified && extension != published_) ++changes_;
  published_ = extension;
}

bool ExtensionPort::Senseless(std::int64_t now_ns) const {
  return now_ns - sense_ns_ > kSenselessNs;
}

}  // namespace footing::handshake
