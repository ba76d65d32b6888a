#include "daemon/simulation/reconstruction/standing_rise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace footing::reconstruction {

void StandingRise::FollowHands(const std::array<HandInput, kHands>& hands) {
  const bool both = hands[0].valid && hands[1].valid;
  if (first_) {
    first_ = false;
    known_ = both;
    for (std::size_t side = 0; side < kHands; ++side) t_pose_W_m_[side] = hands[side].p_W_m;
  }
  if (!known_) {
    away_m_ = std::numeric_limits<double>::infinity();
    return;
  }
  if (!both) return;
  double sum_m = 0;
  for (std::size_t side = 0; side < kHands; ++side) {
    sum_m += (hands[side].p_W_m - t_pose_W_m_[side]).norm();
  }
  away_m_ = std::max(away_m_, sum_m / kHands);
}

FootSpread StandingRise::Advance(const std::array<HandInput, kHands>& hands,
                                 const FootSpread& usual) {
  FollowHands(hands);
  const double left = 1 - std::exp(-away_m_ / usual.leave_m);  // 0 in the T-pose, then 1.
  FootSpread spread = usual;
  spread.ankle_rise *= left;
  spread.toe_rise *= left;
  spread.ankle_up = std::hypot(usual.flat_up, left * usual.ankle_up);
  spread.toe_up = std::hypot(usual.flat_up, left * usual.toe_up);
  return spread;
}

}  // namespace footing::reconstruction
