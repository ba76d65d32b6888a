#include "daemon/sensor/reports/handshake_motion_plus.h"

namespace footing::handshake {
namespace {

// A MotionPlus that was on for longer was switched off by chance.
constexpr std::int64_t kUndoneSoonNs = 10'000'000'000;
constexpr int kUndoneMost = 5;       // Switched off by another program this often in a row: theirs.
constexpr int kChildBitPackets = 4;  // In a row: rubbish packets have the bit at random.

}  // namespace

void MotionPlus::TakeFound() {
  active_ = true;
  calibration = calibration::ParseMotionPlus({});
}

bool MotionPlus::TakeVerification(bool active, std::int64_t now_ns, int tries) {
  active_ = active;
  if (!active_) return ++activations_ < tries;
  activated_ns_ = now_ns;
  return false;
}

void MotionPlus::StartOver() {
  active_ = false;
  activations_ = 0;
  polling_ = false;
}

void MotionPlus::TakeInactive(bool found, std::int64_t now_ns) {
  if (!std::exchange(lost_, false) || !found) return;
  undone_ = now_ns - activated_ns_ < kUndoneSoonNs ? undone_ + 1 : 1;
}

bool MotionPlus::given_up() const { return undone_ >= kUndoneMost; }

bool MotionPlus::ChildChanged(bool connected, bool known) {
  child_bit_differs_ = connected == known ? 0 : child_bit_differs_ + 1;
  if (child_bit_differs_ < kChildBitPackets) return false;
  child_bit_differs_ = 0;
  return true;
}

bool MotionPlus::StartPoll(std::int64_t now_ns, std::int64_t interval_ns) {
  if (active_ || given_up() || now_ns < poll_ns_) return false;
  poll_ns_ = now_ns + interval_ns;
  polling_ = true;
  return true;
}

}  // namespace footing::handshake
