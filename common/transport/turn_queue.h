#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

#include "common/timer/timer.h"

namespace footing::transport {

/// The work of many connections on one loop, in turns: each gets a small piece done and goes to the
/// end of the line. After 1 ms the line rests as long as it worked, at most 4 ms, so that a tick
/// that is due waits for at most a piece, and half of the loop's time is the ticks', however many
/// connections have work.
/// Held by a shared_ptr; runs on the executor's one thread.
class TurnQueue : public std::enable_shared_from_this<TurnQueue> {
 public:
  /// Does a piece; true when there is more to do.
  using Turn = std::function<bool()>;

  explicit TurnQueue(const boost::asio::any_io_executor& executor)
      : executor_(executor), rest_(executor) {}

  /// `turn` is called from the loop, not from here.
  void Add(Turn turn);

  std::size_t waiting() const { return waiting_.size(); }

 private:
  static constexpr std::int64_t kSliceNs = 1'000'000;
  static constexpr std::int64_t kLongestRestNs = 4'000'000;

  void Serve();
  void ServeLater();

  boost::asio::any_io_executor executor_;
  timer::Timer rest_;
  std::deque<Turn> waiting_;
  bool posted_ = false;
};

}  // namespace footing::transport
