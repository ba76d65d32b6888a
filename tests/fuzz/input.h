#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>

namespace footing::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// libFuzzer keeps the input that ends here.
inline void Expect(bool condition) {
  if (!condition) std::abort();
}

/// The fuzzer's bytes as a sequence of numbers and byte strings; zeros and nothing at its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  bool empty() const { return rest_.empty(); }
  std::uint8_t Byte() {
    const Bytes one = Take(1);
    return one.empty() ? std::uint8_t{0} : one[0];
  }
  /// A byte of length, then as many bytes as there are of that.
  Bytes String() { return Take(Byte()); }
  Bytes Rest() { return Take(rest_.size()); }

 private:
  Bytes Take(std::size_t size) {
    const Bytes taken = rest_.first(size < rest_.size() ? size : rest_.size());
    rest_ = rest_.subspan(taken.size());
    return taken;
  }

  Bytes rest_;
};

}  // namespace footing::fuzz
