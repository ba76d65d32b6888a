#include "common/runtime/clock.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <utility>

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace footing::clock {

template <typename Message>
bool ReadMessage(int descriptor, Message& message) {
  ssize_t bytes = 0;
  do {
    bytes = ::recv(descriptor, &message, sizeof message, MSG_WAITALL);
  } while (bytes < 0 && errno == EINTR);
  return bytes == static_cast<ssize_t>(sizeof message);
}

template <typename Message>
bool WriteMessage(int descriptor, const Message& message) {
  ssize_t bytes = 0;
  do {
    bytes = ::send(descriptor, &message, sizeof message, MSG_NOSIGNAL);
  } while (bytes < 0 && errno == EINTR);
  return bytes == static_cast<ssize_t>(sizeof message);
}

template bool ReadMessage(int, TurnEnd&);
template bool ReadMessage(int, Turn&);
template bool WriteMessage(int, const TurnEnd&);
template bool WriteMessage(int, const Turn&);

Result<std::unique_ptr<Follower>> Follower::Connect(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return UsageError("the timekeeper's path is too long: " + path);
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  const int descriptor = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return Failure(std::string("socket: ") + std::strerror(errno));
  std::unique_ptr<Follower> follower(new Follower(path, descriptor));
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      !WriteMessage(descriptor, TurnEnd{.listens = 1})) {
    return Failure("cannot follow the timekeeper at " + path + ": " + std::strerror(errno) +
                   "; unset FOOTING_TIMEKEEPER for the host's time");
  }
  return follower;
}

Follower::~Follower() { ::close(descriptor_); }

void Follower::WaitForTurn() {
  if (ReadMessage(descriptor_, turn_)) return;
  std::fputs("the timekeeper has ended, and so does this process\n", stderr);
  std::_Exit(1);
}

void Follower::EndTurn(std::int64_t due_ns, bool listens) {
  if (!acted_ && due_ns < turn_.alone_until_ns) {
    const std::int64_t passed_ns = std::max<std::int64_t>(0, due_ns - turn_.now_ns);
    turn_.now_ns += passed_ns;
    turn_.wall_ns += passed_ns;
    return;
  }
  TurnEnd end;
  end.now_ns = turn_.now_ns;
  end.due_ns = due_ns;
  end.acted = acted_ ? 1 : 0;
  end.listens = listens ? 1 : 0;
  acted_ = false;
  WriteMessage(descriptor_, end);  // The answer shows whether the timekeeper is there.
  WaitForTurn();
}

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

namespace {

constexpr int kBacklog = 16;
constexpr int kLookEveryMs = 20;
constexpr int kTurnWithinS = 60;

/// Whether something is to be read, or the other side is gone.
bool Readable(int descriptor, int within_ms) {
  pollfd wait{descriptor, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&wait, 1, within_ms);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

}  // namespace

Result<Timekeeper> Timekeeper::Listen(const std::string& path, std::int64_t wall_ns) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) {
    return UsageError("the path of a Unix socket is too long: " + path);
  }
  std::memcpy(address.sun_path, path.data(), path.size());
  const int listening = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (listening < 0) return Failure(std::string("socket: ") + std::strerror(errno));
  Timekeeper keeper(listening, wall_ns);
  if (::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::listen(listening, kBacklog) != 0) {
    return Failure("cannot listen on " + path + ": " + std::strerror(errno));
  }
  return keeper;
}

Timekeeper::Timekeeper(Timekeeper&& other) noexcept
    : listening_(std::exchange(other.listening_, -1)),
      wall_ns_(other.wall_ns_),
      now_ns_(other.now_ns_),
      seats_(std::move(other.seats_)) {}

Timekeeper::~Timekeeper() {
  for (const Seat& seat : seats_) ::close(seat.descriptor);
  if (listening_ >= 0) ::close(listening_);
}

bool Timekeeper::Accept() {
  if (!Readable(listening_, 0)) return false;
  const int descriptor = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
  const timeval within{kTurnWithinS, 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_RCVTIMEO, &within, sizeof within);
  TurnEnd begin;
  if (descriptor < 0 || !ReadMessage(descriptor, begin)) {
    if (descriptor >= 0) ::close(descriptor);
    return false;
  }
  seats_.push_back({descriptor, begin.due_ns, begin.listens != 0, false});
  return true;
}

bool Timekeeper::AwaitFollower(double within_s, const std::function<bool()>& gone) {
  for (int passed_ms = 0; passed_ms < within_s * 1000; passed_ms += kLookEveryMs) {
    if (Readable(listening_, kLookEveryMs)) return Accept();
    if (gone()) return false;
  }
  return false;
}

void Timekeeper::Leave(std::size_t index) {
  ::close(seats_[index].descriptor);
  seats_.erase(seats_.begin() + static_cast<std::ptrdiff_t>(index));
  for (Seat& seat : seats_) seat.called = true;  // Its connections have ended.
}

bool Timekeeper::IsDue(const Seat& seat) const {
  return (seat.listens && seat.called) || seat.due_ns <= now_ns_;
}

/// The first instant at which anybody but this one is due.
std::int64_t Timekeeper::AloneUntil(std::size_t index) const {
  std::int64_t until_ns = kNever;
  for (std::size_t i = 0; i < seats_.size(); ++i) {
    if (i == index) continue;
    until_ns = std::min(until_ns, IsDue(seats_[i]) ? now_ns_ : seats_[i].due_ns);
  }
  return until_ns;
}

/// Whose turn it is, after the time went on where that is due; as many as there are: nobody's.
std::size_t Timekeeper::Next() {
  const auto due = [this](const Seat& seat) { return IsDue(seat); };
  auto next = std::find_if(seats_.begin(), seats_.end(), due);
  if (next == seats_.end()) {
    next = std::min_element(seats_.begin(), seats_.end(),
                            [](const Seat& a, const Seat& b) { return a.due_ns < b.due_ns; });
    if (next == seats_.end() || next->due_ns == kNever) return seats_.size();
    now_ns_ = next->due_ns;
  }
  return static_cast<std::size_t>(next - seats_.begin());
}

bool Timekeeper::GiveTurn() {
  const std::size_t index = Next();
  if (index == seats_.size()) return false;
  Seat& seat = seats_[index];
  seat.called = false;
  TurnEnd end;
  errno = 0;
  const Turn turn{now_ns_, wall_ns_ + now_ns_ - kStartNs, AloneUntil(index)};
  if (!WriteMessage(seat.descriptor, turn) || !ReadMessage(seat.descriptor, end)) {
    if (errno == EAGAIN) return false;
    Leave(index);
    return true;
  }
  now_ns_ = std::max(now_ns_, end.now_ns);
  seat.due_ns = end.due_ns;
  seat.listens = end.listens != 0;
  if (end.acted == 0) return true;
  for (std::size_t i = 0; i < seats_.size(); ++i) seats_[i].called |= i != index;
  while (Accept()) {
  }
  return true;
}

}  // namespace footing::clock
