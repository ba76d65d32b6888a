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
  const std::int64_t rest_ns = pace_.rests_when_empty ? rested_ns_ - clock::MonotonicNs() : 0;
  if (rest_ns > 0) return ServeAfter(rest_ns);
  boost::asio::post(executor_, [self = shared_from_this()] { self->Serve(); });
}

void TurnQueue::ServeAfter(std::int64_t rest_ns) {
  rest_.expires_after(std::chrono::nanoseconds(rest_ns));
  rest_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error) self->Serve();
  });
}

void TurnQueue::Serve() {
  // posted_ stays true: what a turn adds waits for the rest, too.
  const std::int64_t begun_ns = clock::MonotonicNs();
  std::int64_t worked_ns = 0;
  while (!waiting_.empty() && worked_ns < pace_.slice_ns) {
    Turn turn = std::move(waiting_.front());
    waiting_.pop_front();
    if (turn()) waiting_.push_back(std::move(turn));
    worked_ns = clock::MonotonicNs() - begun_ns;
  }
  const auto rest_ns =
      static_cast<std::int64_t>(static_cast<double>(worked_ns) * (1 - pace_.share) / pace_.share);
  const std::int64_t cut_ns = std::min(rest_ns, pace_.longest_rest_ns);
  rested_ns_ = begun_ns + worked_ns + cut_ns;
  posted_ = !waiting_.empty();
  if (posted_) ServeAfter(cut_ns);
}

}  // namespace footing::transport
