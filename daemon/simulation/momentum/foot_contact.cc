#include "daemon/simulation/momentum/foot_contact.h"

#include <algorithm>

namespace footing::momentum {

bool FootContact::Advance(double total_n, double step_s) {
  const double load = total_n - tare_n_;
  const bool now = contact_ ? load > config_.off_n : load > config_.on_n;
  since_s_ = now == contact_ ? since_s_ + step_s : 0;
  contact_ = now;
  if (!contact_) {
    const double share = std::min(1.0, step_s / config_.tare_time_s);
    tare_n_ = std::clamp(tare_n_ + share * load, -config_.most_tare_n, config_.most_tare_n);
  }
  return contact_;
}

}  // namespace footing::momentum
