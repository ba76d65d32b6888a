#include "common/runtime/follower.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

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

}  // namespace footing::clock
