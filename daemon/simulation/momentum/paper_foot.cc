#include "daemon/simulation/momentum/paper_foot.h"

#include <algorithm>

namespace footing::momentum {

void PaperFoot::Target(const Eigen::Vector3d& p_m) {
  from_m_ = place_m_;
  to_m_ = p_m;
  since_target_s_ = 0;
}

void PaperFoot::Advance(const Pressure& pressure, double step_s) {
  contact_ = pressure.cop_valid && pressure.total_n > config_.contact_n;
  since_target_s_ += step_s;
  if (!contact_) {
    zero_s_ += step_s;
    static_s_ = 0;
    had_cop_ = false;
    if (!lifted_ && zero_s_ >= config_.zero_after_s) {
      lifted_ = true;
      Target(to_m_ + config_.lift_m * Eigen::Vector3d::UnitZ());
    }
  } else {
    zero_s_ = 0;
    const double speed =
        had_cop_ ? (pressure.p_WP_m - last_cop_m_).norm() / step_s : 2 * config_.static_mps;
    static_s_ = speed < config_.static_mps ? static_s_ + step_s : 0;
    last_cop_m_ = pressure.p_WP_m;
    had_cop_ = true;
    if (lifted_) {
      lifted_ = false;
      Target(pressure.p_WP_m);
    } else if (since_target_s_ < config_.landing_s || static_s_ >= config_.static_after_s) {
      // A landing goes on to where the COP settles: the first load is on the heel or the ball.
      to_m_ = pressure.p_WP_m;
    }
  }
  const double share = std::min(1.0, since_target_s_ / config_.landing_s);
  place_m_ = from_m_ + share * (to_m_ - from_m_);
}

}  // namespace footing::momentum
