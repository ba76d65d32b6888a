#include "common/runtime/clock.h"

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <utility>

namespace footing::clock {
namespace {

// A free function asks for the time, so each thread stores its follower here.
thread_local std::unique_ptr<Follower> own_follower;

std::int64_t Read(clockid_t id) {
  timespec now{};
  clock_gettime(id, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

std::int64_t MonotonicNs() { return own_follower ? own_follower->now_ns() : Read(CLOCK_MONOTONIC); }
std::int64_t WallNs() { return own_follower ? own_follower->wall_ns() : Read(CLOCK_REALTIME); }
std::int64_t ThreadCpuNs() { return Read(CLOCK_THREAD_CPUTIME_ID); }

void SleepUntil(std::int64_t deadline_ns) {
  if (own_follower) {
    while (own_follower->now_ns() < deadline_ns) own_follower->Sleep(deadline_ns);
    return;
  }
  timespec deadline{};
  deadline.tv_sec = deadline_ns / 1'000'000'000;
  deadline.tv_nsec = deadline_ns % 1'000'000'000;
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
}

Result<void> FollowTimekeeper() {
  const char* path = std::getenv(kTimekeeperVariable);
  if (path == nullptr || *path == '\0') return {};
  auto follower = Follower::Connect(path);
  if (!follower) return follower.error();
  Follow(std::move(follower).value());
  return {};
}

std::unique_ptr<Follower> NewFollower() {
  if (!own_follower) return nullptr;
  auto follower = Follower::Connect(own_follower->path());
  // The timekeeper that this thread follows is there: without it the process has ended.
  if (!follower) CheckFailed("a second follower connects", __FILE__, __LINE__);
  own_follower->Act();  // The timekeeper looks for newcomers after a turn that acted.
  return std::move(follower).value();
}

void Follow(std::unique_ptr<Follower> follower) {
  own_follower = std::move(follower);
  if (own_follower) own_follower->WaitForTurn();
}

void Act() {
  if (own_follower) own_follower->Act();
}

Follower* OwnFollower() { return own_follower.get(); }

}  // namespace footing::clock
