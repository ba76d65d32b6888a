#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <utility>
#include <vector>

namespace footing::study::plan {

/// Random numbers of one purpose: the seed of the protocol and a label give the same numbers on
/// every machine, and a further purpose does not shift those of the others.
class Draw {
 public:
  Draw(std::uint64_t seed, std::string_view purpose);

  /// A whole number in [0, count), each as likely. `count` is at least 1.
  std::size_t Below(std::size_t count);
  std::uint64_t Bits() { return engine_(); }

  template <typename Value>
  void Shuffle(std::vector<Value>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[Below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace footing::study::plan
