#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

namespace footing::sensor {

/// The newest 60 s of a device's samples, oldest first; bounded against a device that floods.
template <typename Sample>
class Recent {
 public:
  static constexpr std::int64_t kSpanNs = 60'000'000'000;
  static constexpr std::size_t kCapacity = 16'384;  // 60 s of 200 samples a second, and some.

  void Add(const Sample& sample) {
    samples_.push_back(sample);
    while (samples_.size() > kCapacity ||
           sample.received_ns - samples_.front().received_ns > kSpanNs) {
      samples_.pop_front();
    }
  }
  void Clear() { samples_.clear(); }

  const std::deque<Sample>& samples() const { return samples_; }

 private:
  std::deque<Sample> samples_;
};

}  // namespace footing::sensor
