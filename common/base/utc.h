#pragma once

#include <cstdint>
#include <string>

namespace footing::text {

/// Nanoseconds of UNIX time as UTC, ISO 8601: 2026-11-22T13:38:48Z; with `decimals` of a second, at
/// most 9: 2026-11-22T13:38:48.123456Z.
std::string Utc(std::int64_t unix_ns, int decimals = 0);

}  // namespace footing::text
