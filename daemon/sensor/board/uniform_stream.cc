#include "daemon/sensor/board/uniform_stream.h"

#include <algorithm>
#include <cmath>

namespace footing::board {
namespace {

constexpr std::size_t kMostSamples = 4096;

void AddWeighted(CornerForces& sum, const CornerForces& forces, double weight) {
  sum.top_left_n += weight * forces.top_left_n;
  sum.top_right_n += weight * forces.top_right_n;
  sum.bottom_left_n += weight * forces.bottom_left_n;
  sum.bottom_right_n += weight * forces.bottom_right_n;
}

}  // namespace

std::int64_t UniformStream::InstantNs(std::int64_t n) const {
  return std::llround(static_cast<double>(n) * 1e9 / config_.rate_hz);
}

void UniformStream::Add(std::int64_t sampled_ns, const CornerForces& forces) {
  if (running_ && sampled_ns <= last_ns_) return;
  if (!running_) {
    running_ = true;
    samples_.clear();
    next_ = static_cast<std::int64_t>(
        std::ceil(static_cast<double>(sampled_ns) * 1e-9 * config_.rate_hz));
  }
  last_ns_ = sampled_ns;
  samples_.push_back({sampled_ns, forces});
  if (samples_.size() > kMostSamples) samples_.pop_front();
}

std::optional<UniformReading> UniformStream::Next(std::int64_t now_ns) {
  if (!running_) return std::nullopt;
  const std::int64_t at_ns = InstantNs(next_);
  const std::int64_t end_ns = at_ns + static_cast<std::int64_t>(config_.window_s * 0.5e9);
  const auto patience_ns = static_cast<std::int64_t>(config_.patience_s * 1e9);
  if (last_ns_ <= end_ns && now_ns < end_ns + patience_ns) return std::nullopt;
  if (static_cast<double>(at_ns - last_ns_) * 1e-9 > config_.longest_gap_s) {
    running_ = false;
    return std::nullopt;
  }
  ++next_;
  return Average(at_ns);
}

UniformReading UniformStream::Average(std::int64_t at_ns) {
  const auto half_ns = static_cast<std::int64_t>(config_.window_s * 0.5e9);
  const std::int64_t from_ns = at_ns - half_ns;
  const std::int64_t to_ns = at_ns + half_ns;
  while (!samples_.empty() && samples_.front().sampled_ns < from_ns) samples_.pop_front();
  UniformReading reading;
  reading.sampled_ns = at_ns;
  const auto end = std::find_if(samples_.begin(), samples_.end(), [to_ns](const Sample& sample) {
    return sample.sampled_ns > to_ns;
  });
  reading.samples = static_cast<std::uint32_t>(end - samples_.begin());
  reading.gap = reading.samples == 0;
  if (!reading.gap) {
    CornerForces mean{0, 0, 0, 0};
    // Instants within a window are small numbers once its beginning is taken off.
    const double width = static_cast<double>(to_ns - from_ns);
    double begin = 0;
    for (auto it = samples_.begin(); it != end; ++it) {
      const auto next = std::next(it);
      const double here = static_cast<double>(it->sampled_ns - from_ns);
      const double border =
          next == end ? width : 0.5 * (here + static_cast<double>(next->sampled_ns - from_ns));
      AddWeighted(mean, it->forces, (border - begin) / width);
      begin = border;
    }
    held_ = mean;
  }
  reading.forces = held_;
  return reading;
}

}  // namespace footing::board
