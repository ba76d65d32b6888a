#include "common/transport/turn_queue.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "common/clock/clock.h"

namespace footing::transport {

void TurnQueue::Add(Turn turn) {
  waiting_.push_back(std::move(turn));
  ServeLater();
}

void TurnQueue::ServeLater() {
  if (std::exchange(posted_, true)) return;
  boost::asio::post(executor_, [self = shared_from_this()] { self->Serve(); });
}

void TurnQueue::Serve() {
  // posted_ stays true: what a turn adds waits for the rest, too.
  const std::int64_t begun_ns = clock::MonotonicNs();
  std::int64_t worked_ns = 0;
  while (!waiting_.empty() && worked_ns < kSliceNs) {
    Turn turn = std::move(waiting_.front());
    waiting_.pop_front();
    if (turn()) waiting_.push_back(std::move(turn));
    worked_ns = clock::MonotonicNs() - begun_ns;
  }
  posted_ = !waiting_.empty();
  if (!posted_) return;
  rest_.expires_after(std::chrono::nanoseconds(std::min(worked_ns, kLongestRestNs)));
  rest_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) self->Serve();
  });
}

}  // namespace footing::transport
