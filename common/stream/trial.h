#pragma once

#include <cstdint>

#include "common/stream/character.h"

namespace footing::stream {

/// The count of one cause; null for kUnspecified.
std::uint64_t* MutableCountOf(FailureCause cause, FailureCounts& counts);
/// The same as a value; 0 for kUnspecified.
std::uint64_t CountOf(FailureCause cause, const FailureCounts& counts);
std::uint64_t Total(const FailureCounts& counts);
/// The counts without the others, each at least 0.
FailureCounts Without(FailureCounts counts, const FailureCounts& others);

}  // namespace footing::stream
