#include "daemon/sensor/features/sample_grid.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace footing::features {
namespace {

/// The first grid index at or after an instant.
std::int64_t IndexAtOrAfter(std::int64_t time_ns) {
  const std::int64_t index = time_ns / kGridStepNs;
  return index * kGridStepNs < time_ns ? index + 1 : index;
}

}  // namespace

void SampleGrid::Start(const Knot& knot) {
  started_ = true;
  ++beginnings_;
  begin_ = end_ = 0;
  knot_ = knot;
  last_ns_ = knot.time_ns;
  next_index_ = IndexAtOrAfter(knot.time_ns);
  if (next_index_ * kGridStepNs == knot.time_ns) {
    Push(knot.raw, knot.filtered, knot.clipped);
    ++next_index_;
  }
}

void SampleGrid::Push(const Eigen::Vector3d& raw, const Eigen::Vector3d& filtered,
                      std::uint32_t clipped) {
  if (end_ == 2 * kGridLength) {
    const int kept = kGridLength - 1;
    raw_.topRows(kept) = raw_.middleRows(end_ - kept, kept).eval();
    filtered_.topRows(kept) = filtered_.middleRows(end_ - kept, kept).eval();
    std::copy(clipped_.end() - kept, clipped_.end(), clipped_.begin());
    begin_ = 0;
    end_ = kept;
  }
  raw_.row(end_) = raw.transpose();
  filtered_.row(end_) = filtered.transpose();
  clipped_[end_] = clipped;
  ++end_;
  begin_ = std::max(begin_, end_ - kGridLength);
}

void SampleGrid::Append(const Knot& knot) {
  const double span = static_cast<double>(knot.time_ns - knot_.time_ns);
  for (; next_index_ * kGridStepNs <= knot.time_ns; ++next_index_) {
    const double share = static_cast<double>(next_index_ * kGridStepNs - knot_.time_ns) / span;
    std::uint32_t clipped = 0;
    if (share > 0) clipped |= knot.clipped;
    if (share < 1) clipped |= knot_.clipped;
    Push(knot_.raw + share * (knot.raw - knot_.raw),
         knot_.filtered + share * (knot.filtered - knot_.filtered), clipped);
  }
  knot_ = knot;
}

void SampleGrid::Add(const stream::MotionSample& sample) {
  if (!sample.specific_force_mps2.allFinite() || !sample.filtered_mps2.allFinite()) return;
  const Knot knot{sample.sampled_ns, sample.specific_force_mps2, sample.filtered_mps2,
                  sample.clipped_axes};
  const double since_s = NanosecondsToSeconds(sample.sampled_ns - last_ns_);
  if (!started_ || std::abs(since_s) > config_.longest_pause_s) {
    Start(knot);
    return;
  }
  if (since_s <= 0) return;
  last_ns_ = sample.sampled_ns;
  const double unknown_s = NanosecondsToSeconds(sample.sampled_ns - knot_.time_ns);
  if (sample.repeated && unknown_s < config_.longest_repeat_s) return;
  Append(knot);
}

}  // namespace footing::features
