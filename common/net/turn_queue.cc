#include "common/net/turn_queue.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <boost/asio/post.hpp>

#include "common/runtime/clock.h"

namespace footing::transport {

void TurnQueue::Add(Turn turn) {
  // In Serve(), too: what a turn adds waits for the rest.
  if (const auto line = waiting_.lock()) return line->push_back(std::move(turn));
  auto line = std::make_shared<Line>();
  line->push_back(std::move(turn));
  waiting_ = line;
  const std::int64_t rest_ns = pace_.rests_when_empty ? rested_ns_ - clock::MonotonicNs() : 0;
  if (rest_ns > 0) return ServeAfter(rest_ns, std::move(line));
  boost::asio::post(executor_, [self = shared_from_this(), line = std::move(line)]() mutable {
    self->Serve(std::move(line));
  });
}

void TurnQueue::ServeAfter(std::int64_t rest_ns, std::shared_ptr<Line> line) {
  rest_.After(std::chrono::nanoseconds(rest_ns),
              [self = shared_from_this(), line = std::move(line)]() mutable {
                self->Serve(std::move(line));
              });
}

void TurnQueue::Serve(std::shared_ptr<Line> line) {
  const std::int64_t begun_ns = clock::MonotonicNs();
  std::int64_t worked_ns = 0;
  while (!line->empty() && worked_ns < pace_.slice_ns) {
    Turn turn = std::move(line->front());
    line->pop_front();
    if (turn()) line->push_back(std::move(turn));
    worked_ns = clock::MonotonicNs() - begun_ns;
  }
  const auto rest_ns =
      static_cast<std::int64_t>(static_cast<double>(worked_ns) * (1 - pace_.share) / pace_.share);
  const std::int64_t cut_ns = std::min(rest_ns, pace_.longest_rest_ns);
  rested_ns_ = begun_ns + worked_ns + cut_ns;
  if (!line->empty()) ServeAfter(cut_ns, std::move(line));
}

}  // namespace footing::transport
