#pragma once

#include <cstdint>

/// The clocks of the host. Pure code takes time as an argument instead.
namespace footing::clock {

/// CLOCK_MONOTONIC in nanoseconds: the clock of every stamp in the protocol.
std::int64_t MonotonicNs();

/// UNIX time in nanoseconds: only to date recordings and to anchor MonotonicNs() in a Welcome.
std::int64_t WallNs();

/// CPU time of the calling thread in nanoseconds.
std::int64_t ThreadCpuNs();

/// Waits until MonotonicNs() reaches `deadline_ns`.
void SleepUntil(std::int64_t deadline_ns);

}  // namespace footing::clock
