#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace footing::reconstruction {

/// Values of the last frames, to go back to one of them. A value that allocates nothing.
template <typename T, std::size_t kSlots>
class Delay {
 public:
  void Clear() { count_ = 0; }
  void Add(const T& value) { values_[count_++ % kSlots] = value; }
  /// The value of `steps` (below kSlots) frames ago, or the first one where there are fewer. Not
  /// before the first Add.
  const T& Back(std::size_t steps) const {
    return values_[(count_ - std::min(count_, steps + 1)) % kSlots];
  }

 private:
  std::array<T, kSlots> values_{};
  std::size_t count_ = 0;
};

}  // namespace footing::reconstruction
