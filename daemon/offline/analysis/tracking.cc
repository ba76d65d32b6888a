#include "daemon/offline/analysis/tracking.h"

#include <cmath>
#include <numeric>

namespace footing::tracking {

void SpeedOverAStep::Add(double speed_mps) {
  last_mps_[next_] = speed_mps;
  next_ = (next_ + 1) % last_mps_.size();
}

double SpeedOverAStep::mean_mps() const {
  const double sum_mps = std::accumulate(last_mps_.begin(), last_mps_.end(), 0.0);
  return sum_mps / static_cast<double>(last_mps_.size());
}

Tracking CheckTracking(const GivenCommand& given, double time_s, const stream::GaitState& state,
                       double mean_mps) {
  if (time_s - given.time_s < kLongCommandS) return Tracking::kShort;
  if (state.falls != given.falls_before) return Tracking::kFell;
  if (state.pending) return Tracking::kOtherGait;
  return std::fabs(mean_mps - given.speed_mps) < kTrackedMps ? Tracking::kTracked
                                                             : Tracking::kOffSpeed;
}

}  // namespace footing::tracking
