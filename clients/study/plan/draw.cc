#include "clients/study/plan/draw.h"

#include <limits>

#include "common/base/fnv.h"

namespace footing::study::plan {

/// FNV-1a, started with the seed.
Draw::Draw(std::uint64_t seed, std::string_view purpose) {
  std::uint64_t hash = text::kFnvBasis;
  const auto mix = [&hash](unsigned char byte) { hash = text::AddFnv(hash, byte); };
  for (int i = 0; i < 8; ++i) mix(static_cast<unsigned char>(seed >> (8 * i)));
  for (const char c : purpose) mix(static_cast<unsigned char>(c));
  engine_.seed(hash);
}

std::size_t Draw::Below(std::size_t count) {
  constexpr std::uint64_t kGreatest = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t whole = kGreatest - kGreatest % count;  // A multiple: no remainder is rarer.
  for (;;) {
    const std::uint64_t bits = engine_();
    if (bits < whole) return static_cast<std::size_t>(bits % count);
  }
}

}  // namespace footing::study::plan
