#include "tests/fuzz/simulated_time.h"

#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>
#include <thread>
#include <utility>

#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "tests/fuzz/input.h"

namespace footing::fuzz {

void FollowSimulatedTime() {
  if (clock::OwnFollower() != nullptr) return;
  std::string folder = "/tmp/footing-fuzz-XXXXXX";
  Expect(mkdtemp(folder.data()) != nullptr);
  const std::string path = folder + "/time";
  auto timekeeper = clock::Timekeeper::Listen(path, 1'700'000'000'000'000'000);
  Expect(timekeeper.ok());
  auto follower = clock::Follower::Connect(path);
  Expect(follower.ok());
  // It lives as long as the process.
  std::thread([keeper = std::make_shared<clock::Timekeeper>(std::move(*timekeeper))] {
    (void)keeper->AwaitFollower(10, [] { return false; });
    for (;;) (void)keeper->GiveTurn();
  }).detach();
  clock::Follow(std::move(*follower));
  unlink(path.c_str());
  rmdir(folder.c_str());
}

void RunFor(boost::asio::io_context& io, double seconds, const std::function<bool()>& done) {
  io.restart();
  while (!done() && io.poll_one() > 0) {
  }
  // Only what takes time asks the timekeeper, which takes long.
  if (seconds <= 0 || done()) return;
  io.restart();  // It may have run out of work, and a stopped one would never come to the end.
  (void)timer::RunUntil(io, done, seconds, [] { return false; });
}

void RawPeer::Take(int descriptor) {
  Close();
  descriptor_ = descriptor;
}

void RawPeer::Write(std::string_view bytes) {
  if (!open() || bytes.empty()) return;
  (void)::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

std::string RawPeer::Read() {
  std::string all;
  std::array<char, 16 << 10> some;
  while (open()) {
    const ssize_t size = ::recv(descriptor_, some.data(), some.size(), MSG_DONTWAIT);
    if (size <= 0) break;
    all.append(some.data(), static_cast<std::size_t>(size));
  }
  return all;
}

void RawPeer::EndWriting() {
  if (open()) ::shutdown(descriptor_, SHUT_WR);
}

void RawPeer::Close() {
  if (open()) ::close(descriptor_);
  descriptor_ = -1;
}

}  // namespace footing::fuzz
