#include "daemon/simulation/mapping/settled_gait.h"

#include <algorithm>

namespace footing::mapping {

using stream::Gait;

void SettledGait::Reset(Gait gait) {
  gait_ = gait;
  next_ = Gait::kUnspecified;
}

void SettledGait::Pause(double time_s) { time_s_ = time_s; }

Gait SettledGait::Advance(double time_s, Gait seen, double lasting_s) {
  const double elapsed_s = time_s - time_s_;
  time_s_ = time_s;
  if (seen == gait_) {
    Reset(gait_);
    return gait_;
  }
  lasted_s_ = seen == next_ ? lasted_s_ + elapsed_s : 0;
  next_ = seen;
  share_ = lasting_s > 0 ? std::clamp(lasted_s_ / lasting_s, 0.0, 1.0) : 1;
  if (lasted_s_ >= lasting_s) Reset(seen);
  return gait_;
}

}  // namespace footing::mapping
