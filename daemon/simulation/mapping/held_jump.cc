#include "daemon/simulation/mapping/held_jump.h"

namespace footing::mapping {

void HeldJump::Start(double time_s) {
  active_ = true;
  jumps_ = false;
  since_s_ = time_s;
}

bool HeldJump::Advance(double time_s, stream::Gait running, bool held) {
  if (!active_) return false;
  if (!jumps_ && running == stream::Gait::kJump) {
    jumps_ = true;
    since_s_ = time_s;
  }
  active_ = held || time_s - since_s_ < (jumps_ ? after_s_ : kMostWaitS);
  return active_;
}

}  // namespace footing::mapping
