#pragma once

#include <cstdint>

/// Stamps that come from files and other programs may be anything; clocks reach only some of them.
namespace footing {

/// Instants and offsets beyond it, 73 years either way, are refused: sums of three of them cannot
/// overflow.
inline constexpr std::int64_t kMostInstantNs = std::int64_t{1} << 61;

constexpr bool IsInstant(std::int64_t time_ns) {
  return time_ns >= -kMostInstantNs && time_ns <= kMostInstantNs;
}
constexpr bool IsInstant(std::uint64_t time_ns) {
  return time_ns <= static_cast<std::uint64_t>(kMostInstantNs);
}

}  // namespace footing
