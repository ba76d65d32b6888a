#pragma once

#include <cstdint>

namespace footing::text {

/// FNV-1a over 64-bit words instead of bytes: a fingerprint of a state. Starts at the basis and
/// takes one word after the other; the same bits give the same hash.
inline constexpr std::uint64_t kFnvBasis = 14695981039346656037u;
constexpr std::uint64_t AddFnv(std::uint64_t hash, std::uint64_t word) {
  return (hash ^ word) * 1099511628211u;
}

}  // namespace footing::text
