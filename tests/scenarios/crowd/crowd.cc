#include "tests/scenarios/crowd/crowd.h"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/socket.h"
#include "common/runtime/clock.h"

namespace footing::crowd {
namespace {

constexpr std::size_t kAtOnce = 64;  // Viewers that are being taken in.
constexpr std::int64_t kPatienceNs = 10'000'000'000;
constexpr std::size_t kReadBytes = 64 << 10;

Error System(const std::string& what) { return Failure(what + ": " + std::strerror(errno)); }

bool Send(int socket, const v1::Envelope& message) {
  const std::string frame = transport::Frame(message.SerializeAsString());
  return send(socket, frame.data(), frame.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(frame.size());
}

std::string WhyEnded(std::string_view payload) {
  v1::Envelope message;
  if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return "?";
  return message.has_refused() ? message.refused().message() : message.goodbye().reason();
}

}  // namespace

Crowd::Crowd(std::vector<transport::Address> addresses)
    : addresses_(std::move(addresses)),
      epoll_(epoll_create1(EPOLL_CLOEXEC)),
      sequences_(addresses_.size()) {}

Crowd::~Crowd() {
  for (const Viewer& viewer : viewers_) close(viewer.socket);
  close(epoll_);
}

Result<void> Crowd::Add(std::size_t address) {
  const auto endpoint = transport::EndpointOf(addresses_[address]);
  if (!endpoint) return endpoint.error();
  Viewer viewer;
  viewer.address = address;
  viewer.socket = socket(endpoint->protocol().family(), SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (viewer.socket < 0) return System("a socket; see ulimit -n");
  const std::size_t number = viewers_.size();
  viewers_.push_back(std::move(viewer));
  const int socket = viewers_.back().socket;
  if (connect(socket, endpoint->data(), static_cast<socklen_t>(endpoint->size())) != 0) {
    return System(addresses_[address].Text());
  }
  transport::ClientOptions options;
  options.client_name = "crowd";
  v1::Envelope subscribe;
  subscribe.mutable_subscribe()->set_policy(v1::QUEUE_POLICY_DROP_OLDEST);
  const auto hello = transport::MakeHello(options);
  if (!hello) return hello.error();
  if (!Send(socket, *hello) || !Send(socket, subscribe)) return System("send");
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = number;
  if (epoll_ctl(epoll_, EPOLL_CTL_ADD, socket, &event) != 0) return System("epoll");
  return {};
}

Result<void> Crowd::Connect(std::size_t viewers) {
  viewers_.reserve(viewers);
  std::int64_t progress_ns = clock::MonotonicNs();
  while (subscribed_ < viewers) {
    while (viewers_.size() < viewers && viewers_.size() - subscribed_ < kAtOnce) {
      if (auto added = Add(viewers_.size() % addresses_.size()); !added) return added;
    }
    const std::size_t before = subscribed_;
    if (auto polled = Poll(100); !polled) return polled;
    const std::int64_t now_ns = clock::MonotonicNs();
    if (subscribed_ > before) progress_ns = now_ns;
    if (now_ns - progress_ns > kPatienceNs) {
      return Failure("only " + std::to_string(subscribed_) + " viewers were taken in");
    }
  }
  return {};
}

Result<void> Crowd::Read(std::int64_t end_ns, std::int64_t from_ns, std::int64_t to_ns) {
  from_ns_ = from_ns;
  to_ns_ = to_ns;
  while (clock::MonotonicNs() < end_ns) {
    if (auto polled = Poll(10); !polled) return polled;
  }
  return {};
}

Result<void> Crowd::Poll(int timeout_ms) {
  std::array<epoll_event, 512> events;
  const int count = epoll_wait(epoll_, events.data(), events.size(), timeout_ms);
  if (count < 0 && errno != EINTR) return System("epoll");
  for (int i = 0; i < count; ++i) {
    Viewer& viewer = viewers_[events[static_cast<std::size_t>(i)].data.u64];
    if (auto read = ReadSome(viewer); !read) return read;
  }
  return {};
}

Result<void> Crowd::ReadSome(Viewer& viewer) {
  std::array<char, kReadBytes> bytes;
  const ssize_t count = recv(viewer.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  if (count <= 0) return Failure("a viewer was sent away");
  tally_.bytes += static_cast<std::uint64_t>(count);
  std::string ended;
  viewer.frames.Take(
      {bytes.data(), static_cast<std::size_t>(count)}, [&](std::string_view payload) {
        TickHead tick;
        switch (Look(payload, tick)) {
          case FrameKind::kTick:
            if (!std::exchange(viewer.subscribed, true)) ++subscribed_;
            return OnTick(viewer, tick);
          case FrameKind::kGap:
            ++tally_.gaps;
            return;
          case FrameKind::kPing: {
            v1::Envelope ping;
            const std::int64_t now_ns = clock::MonotonicNs();
            if (ping.ParseFromArray(payload.data(), static_cast<int>(payload.size())))
              Send(viewer.socket, transport::MakePong(ping.ping(), now_ns, now_ns));
            return;
          }
          case FrameKind::kEnd:
            ended = WhyEnded(payload);
            return;
          case FrameKind::kOther:
            return;
        }
      });
  if (!ended.empty()) return Failure("a viewer was refused, or sent away: " + ended);
  return {};
}

void Crowd::OnTick(const Viewer& viewer, const TickHead& tick) {
  if (!tick.live || tick.host_ns < from_ns_ || tick.host_ns >= to_ns_) return;
  ++tally_.delivered;
  tally_.lags_ms.push_back(1e-6 * static_cast<double>(clock::MonotonicNs() - tick.host_ns));
  sequences_[viewer.address].insert(tick.sequence);
}

Tally Crowd::tally() const {
  Tally tally = tally_;
  for (const Viewer& viewer : viewers_) tally.expected += sequences_[viewer.address].size();
  tally.rate_hz =
      1e9 * static_cast<double>(sequences_[0].size()) / static_cast<double>(to_ns_ - from_ns_);
  return tally;
}

}  // namespace footing::crowd
