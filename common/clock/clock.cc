#include "common/clock/clock.h"

#include <cerrno>
#include <ctime>

namespace footing::clock {
namespace {

std::int64_t Read(clockid_t id) {
  timespec now{};
  clock_gettime(id, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t MonotonicNs() { return Read(CLOCK_MONOTONIC); }
std::int64_t WallNs() { return Read(CLOCK_REALTIME); }
std::int64_t ThreadCpuNs() { return Read(CLOCK_THREAD_CPUTIME_ID); }

void SleepUntil(std::int64_t deadline_ns) {
  timespec deadline{};
  deadline.tv_sec = deadline_ns / 1'000'000'000;
  deadline.tv_nsec = deadline_ns % 1'000'000'000;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

}  // namespace footing::clock
