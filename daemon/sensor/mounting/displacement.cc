#include "daemon/sensor/mounting/displacement.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::tare {
namespace {

constexpr std::int64_t kPauseNs = 250'000'000;

double Largest(const board::CornerForces& forces) {
  return std::max({std::abs(forces.top_left_n), std::abs(forces.top_right_n),
                   std::abs(forces.bottom_left_n), std::abs(forces.bottom_right_n)});
}

}  // namespace

bool Displacement::Advance(std::int64_t sampled_ns, const board::CornerForces& tared) {
  const double total_n = Total(tared);
  const bool quiet = started_ && Largest(tared - last_) <= config_.quiet_n;
  // A pause proves nothing about what happened in it.
  if (!started_ || sampled_ns - last_ns_ > kPauseNs) grounded_ns_ = level_ns_ = sampled_ns;
  started_ = true;
  last_ns_ = sampled_ns;
  last_ = tared;
  if (total_n > config_.lifted_n) grounded_ns_ = sampled_ns;
  const bool stands_otherwise =
      quiet && std::abs(total_n) <= config_.empty_n && Largest(tared) > config_.corner_n;
  if (!stands_otherwise) level_ns_ = sampled_ns;
  const auto since_s = [sampled_ns](std::int64_t then_ns) {
    return NanosecondsToSeconds(sampled_ns - then_ns);
  };
  moved_ =
      moved_ || since_s(grounded_ns_) >= config_.lifted_s || since_s(level_ns_) >= config_.rests_s;
  return moved_;
}

}  // namespace footing::tare
