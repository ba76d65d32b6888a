#include "common/runtime/timer.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <utility>

#include <boost/asio/error.hpp>
#include <boost/asio/execution/outstanding_work.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/prefer.hpp>

#include "common/base/units.h"
#include "common/runtime/clock.h"

namespace footing::timer {
namespace {

namespace asio = boost::asio;

/// A wait on simulated time. Its executor counts as work: the event loop goes on until it is over.
struct Waiting {
  asio::any_io_executor executor;
  Timer::Handler handler;

  void Post(const boost::system::error_code& error) {
    asio::post(executor, [handler = std::move(handler), error] { handler(error); });
  }
};

/// Waits of one thread that follows a timekeeper, by expiry and, within an instant, in their order.
struct Waits {
  std::map<std::pair<TimePoint, std::uint64_t>, Waiting> by_expiry;
  std::uint64_t last = 0;

  TimePoint Next() const {
    return by_expiry.empty() ? TimePoint::max() : by_expiry.begin()->first.first;
  }
  /// Those that have expired go to their event loop.
  bool PostDue() {
    bool any = false;
    while (Next() <= Now()) {
      by_expiry.begin()->second.Post({});
      by_expiry.erase(by_expiry.begin());
      any = true;
    }
    return any;
  }
};

thread_local Waits waits;

}  // namespace

TimePoint Now() { return TimePoint(std::chrono::nanoseconds(clock::MonotonicNs())); }

void Timer::expires_at(TimePoint expiry) {
  cancel();
  expiry_ = expiry;
  if (clock::OwnFollower() == nullptr) real_.expires_at(expiry);
}

void Timer::async_wait(Handler own_handler) {
  Handler handler = [cancelled = cancelled_, number = *cancelled_,
                     own_handler = std::move(own_handler)](const boost::system::error_code& error) {
    own_handler(*cancelled == number ? error : asio::error::operation_aborted);
  };
  if (clock::OwnFollower() == nullptr) return real_.async_wait(std::move(handler));
  simulated_ = ++waits.last;
  waits.by_expiry.emplace(
      std::pair(expiry_, simulated_),
      Waiting{asio::prefer(real_.get_executor(), asio::execution::outstanding_work.tracked),
              std::move(handler)});
}

void Timer::At(TimePoint expiry, std::function<void()> then) {
  expires_at(expiry);
  async_wait([then = std::move(then)](const boost::system::error_code& error) {
    if (!error) then();
  });
}

void Timer::After(double wait_s, std::function<void()> then) {
  After(std::chrono::nanoseconds(SecondsToNanoseconds(wait_s)), std::move(then));
}

void Timer::cancel() {
  ++*cancelled_;
  real_.cancel();
  if (simulated_ == 0) return;
  const auto waiting = waits.by_expiry.find({expiry_, simulated_});
  simulated_ = 0;
  if (waiting == waits.by_expiry.end()) return;  // It has expired.
  waiting->second.Post(asio::error::operation_aborted);
  waits.by_expiry.erase(waiting);
}

void DropWaits() {
  // By exchange: the handlers may hold timers, whose ends change the map.
  std::exchange(waits.by_expiry, {});
}

void Run(asio::io_context& io) {
  if (clock::OwnFollower() == nullptr) {
    io.run();
    return;
  }
  while (!io.stopped()) RunOneUntil(io, TimePoint::max());
  DropWaits();
}

void RunOneUntil(asio::io_context& io, TimePoint end) {
  clock::Follower* follower = clock::OwnFollower();
  if (follower == nullptr) {
    io.run_one_until(end);
    return;
  }
  while (Now() < end) {
    if (io.poll_one() > 0) return;
    if (io.stopped()) return;
    if (waits.PostDue()) continue;
    follower->Listen(std::min(end, waits.Next()).time_since_epoch().count());
  }
}

Waited RunUntil(boost::asio::io_context& io, const std::function<bool()>& condition,
                double within_s, const std::function<bool()>& interrupted) {
  const auto work = boost::asio::make_work_guard(io);  // Or it would stop, and not wait.
  const TimePoint end = Now() + std::chrono::nanoseconds(SecondsToNanoseconds(within_s));
  for (;;) {
    if (interrupted()) return Waited::kInterrupted;
    if (condition && condition()) return Waited::kDone;
    if (Now() >= end) return Waited::kTimeUp;
    RunOneUntil(io, end);
  }
}

}  // namespace footing::timer
