#include "daemon/sensor/reports/link_statistics.h"

#include <cmath>

#include "common/base/units.h"

namespace footing::link {
namespace {

constexpr double kTimeConstantS = 1;
constexpr double kGapPeriods = 5;

}  // namespace

void LinkStatistics::Advance(std::int64_t received_ns) {
  ++reports_;
  const double interval_s = NanosecondsToSeconds(received_ns - last_ns_);
  last_ns_ = received_ns;
  if (reports_ == 1) return;
  if (interval_s > kGapPeriods * nominal_period_s_) ++gaps_;
  if (reports_ == 2) {
    mean_s_ = interval_s;
    return;
  }
  const double weight = nominal_period_s_ / kTimeConstantS;
  const double error_s = interval_s - mean_s_;
  mean_s_ += weight * error_s;
  variance_s2_ += weight * (error_s * error_s - variance_s2_);
}

double LinkStatistics::RateHz(std::int64_t now_ns) const {
  const bool silent = now_ns - last_ns_ > kNanosecondsPerSecond;
  return silent || mean_s_ <= 0 ? 0 : 1 / mean_s_;
}

double LinkStatistics::JitterMs() const { return std::sqrt(variance_s2_) * 1e3; }

}  // namespace footing::link
