#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <utility>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/post.hpp>

#include "common/net/admission.h"
#include "common/net/socket.h"
#include "common/runtime/timer.h"

namespace footing::transport {

/// How much of the loop's time a TurnQueue takes: after `slice_ns` it rests, until it has worked
/// for no more than that share of the time, but for at most `longest_rest_ns`.
struct TurnPace {
  double share = 0.5;
  std::int64_t slice_ns = 250'000;
  std::int64_t longest_rest_ns = 4'000'000;
  bool rests_when_empty = false;  ///< Also what comes right after the last turn waits for the rest.
};

/// The work of many connections on one loop, in turns: each gets a small piece done and goes to the
/// end of the line. The line rests in between, so that a tick that is due waits for at most a
/// piece, and the rest of the loop's time is the ticks', however many connections have work. Held
/// by a shared_ptr; runs on the executor's one thread. What waits belongs to the loop: it may hold
/// this queue, and goes when the loop is destroyed.
class TurnQueue : public std::enable_shared_from_this<TurnQueue> {
 public:
  /// Does a piece; true when there is more to do.
  using Turn = std::function<bool()>;

  explicit TurnQueue(const boost::asio::any_io_executor& executor, const TurnPace& pace = {})
      : executor_(executor), pace_(pace), rest_(executor) {}

  /// `turn` is called from the loop, not from here.
  void Add(Turn turn);

  std::size_t waiting() const {
    const auto line = waiting_.lock();
    return line ? line->size() : 0;
  }

 private:
  using Line = std::deque<Turn>;

  void Serve(std::shared_ptr<Line> line);
  void ServeAfter(std::int64_t rest_ns, std::shared_ptr<Line> line);

  boost::asio::any_io_executor executor_;
  const TurnPace pace_;
  timer::Timer rest_;
  std::int64_t rested_ns_ = 0;   ///< The end of the newest rest.
  std::weak_ptr<Line> waiting_;  ///< Held by what the loop will call next, or is in now.
};

/// Resources that the connections of one thread share: empty batches, and the line in which each
/// gets a small piece of its work done. Without the line a connection does its work as it comes.
struct SharedLoop {
  std::shared_ptr<BatchPool> pool = std::make_shared<BatchPool>();
  std::shared_ptr<TurnQueue> turns;

  /// Calls `work` later, when its turn comes.
  void InTurn(const Socket::executor_type& executor, std::function<void()> work) const {
    if (!turns) return boost::asio::post(executor, std::move(work));
    turns->Add([work = std::move(work)] { return work(), false; });
  }
};

}  // namespace footing::transport
