#pragma once

#include <cstdint>
#include <memory>

#include "common/runtime/follower.h"
#include "common/base/result.h"

/// The clocks of the host. Pure code takes time as an argument instead.
///
/// Where the process follows a timekeeper its threads have simulated time: it stands still while
/// they work, and goes on to the next instant at which one of them has something to do. Then a
/// study of hours runs in minutes, and equal inputs give equal bits.
namespace footing::clock {

/// CLOCK_MONOTONIC in nanoseconds: the clock of every stamp in the protocol.
std::int64_t MonotonicNs();

/// UNIX time in nanoseconds: only to date recordings and to anchor MonotonicNs() in a Welcome.
std::int64_t WallNs();

/// CPU time of the calling thread in nanoseconds; never simulated.
std::int64_t ThreadCpuNs();

/// Waits until MonotonicNs() reaches `deadline_ns`.
void SleepUntil(std::int64_t deadline_ns);

/// Of the environment: the socket of the timekeeper that the programs started with it follow.
constexpr char kTimekeeperVariable[] = "FOOTING_TIMEKEEPER";

/// Lets the calling thread follow the timekeeper of the environment, if there is one, from its
/// first turn on, for which it waits. Of a program call it in main, before anything asks for the
/// time.
Result<void> FollowTimekeeper();

/// A follower for a thread that is about to be started, which hands it to Follow(); null in a
/// thread that follows none. Made before, so that time stands still until the new thread has had a
/// turn.
std::unique_ptr<Follower> NewFollower();
/// Nothing happens without a follower. Waits for the calling thread's first turn.
void Follow(std::unique_ptr<Follower> follower);

/// The calling thread does something that another thread or process may be waiting for, such as a
/// write to a socket: who follows the same timekeeper and listens has a turn at this instant.
void Act();

/// Of the calling thread; null: it has the host's time.
Follower* OwnFollower();

}  // namespace footing::clock
