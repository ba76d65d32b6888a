#include "common/runtime/timekeeper.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace footing::clock {
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
