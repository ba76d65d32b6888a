#include "common/net/clock_offset.h"

#include <algorithm>
#include <cstdlib>

namespace footing::transport {
namespace {

/// 73 years: no host has been up for that, and no sum of such stamps below leaves 64 bits.
constexpr std::int64_t kEndNs = std::int64_t{1} << 61;

bool AreStamps(const Probe& probe) {
  const auto [first, last] = std::minmax({probe.t0_ns, probe.t1_ns, probe.t2_ns, probe.t3_ns});
  return first >= 0 && last < kEndNs && probe.t1_ns != 0 && probe.t2_ns != 0;
}

}  // namespace

void ClockOffsetEstimator::Add(const Probe& probe) {
  if (!AreStamps(probe)) return;
  const std::int64_t round_trip = (probe.t3_ns - probe.t0_ns) - (probe.t2_ns - probe.t1_ns);
  if (probe.t3_ns < probe.t0_ns || probe.t2_ns < probe.t1_ns || round_trip < 0) return;
  const std::int64_t out = probe.t1_ns - probe.t0_ns;
  const std::int64_t back = probe.t2_ns - probe.t3_ns;
  samples_.push_back({back + (out - back) / 2, round_trip});
  if (samples_.size() > kProbes) samples_.pop_front();
  const auto best = std::min_element(
      samples_.begin(), samples_.end(),
      [](const Sample& a, const Sample& b) { return a.round_trip_ns < b.round_trip_ns; });
  Approach(*best, probe.t3_ns);
  settled_ = settled_ || samples_.size() == kProbes;
}

void ClockOffsetEstimator::Approach(const Sample& best, std::int64_t now_ns) {
  const std::int64_t bound = best.round_trip_ns / 2 + 1;
  const std::int64_t to_go = best.offset_ns - estimate_.offset_ns;
  const bool contradicts = std::abs(to_go) > bound + estimate_.uncertainty_ns;
  if (!settled_ || contradicts) {
    estimate_ = {true, best.offset_ns, bound};
  } else {
    const auto reach = static_cast<std::int64_t>(
        kMaxSlew * static_cast<double>(std::max<std::int64_t>(0, now_ns - moved_ns_)));
    const std::int64_t step = std::clamp(to_go, -reach, reach);
    estimate_.offset_ns += step;
    estimate_.uncertainty_ns = bound + std::abs(to_go - step);
  }
  moved_ns_ = now_ns;
}

}  // namespace footing::transport
