#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>

/// Timers and event loops on the clock of common/runtime: the host's, or that of the timekeeper
/// that the calling thread follows.
namespace footing::timer {

using TimePoint = std::chrono::steady_clock::time_point;

/// clock::MonotonicNs() as a time point.
TimePoint Now();

/// A steady_timer of Asio for one wait at a time: a new expiry cancels the wait. Unlike in Asio a
/// wait that has expired can be cancelled as well, until its handler runs: so a handler that
/// returns on an error may hold a pointer to the timer's owner. A thread that follows a timekeeper
/// runs its io_context with Run or RunOneUntil below, or it never expires.
class Timer {
 public:
  using Handler = std::function<void(const boost::system::error_code&)>;

  explicit Timer(const boost::asio::any_io_executor& executor) : real_(executor) {}
  explicit Timer(boost::asio::io_context& io) : real_(io) {}
  ~Timer() { cancel(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  void expires_at(TimePoint expiry);
  TimePoint expiry() const { return expiry_; }
  void expires_after(std::chrono::nanoseconds wait) { expires_at(Now() + wait); }
  /// The handler is called on the io_context, with operation_aborted after a cancel.
  void async_wait(Handler handler);
  /// Waits and then calls `then` on the io_context. After a cancel it is not called any more, so it
  /// may hold a pointer to the timer's owner.
  void At(TimePoint expiry, std::function<void()> then);
  void After(std::chrono::nanoseconds wait, std::function<void()> then) {
    At(Now() + wait, std::move(then));
  }
  void After(double wait_s, std::function<void()> then);
  void cancel();

 private:
  boost::asio::steady_timer real_;
  TimePoint expiry_;
  std::uint64_t simulated_ = 0;  ///< Number of the wait on simulated time; 0: none.
  /// How many waits were cancelled; handlers share it.
  std::shared_ptr<std::uint64_t> cancelled_ = std::make_shared<std::uint64_t>(0);
};

/// Forgets the calling thread's waits on simulated time, whose handlers may hold what belongs to an
/// io_context: before that io_context ends. Run does it.
void DropWaits();

/// io.run().
void Run(boost::asio::io_context& io);
/// io.run_one_until(end): returns after one handler, at the end, or when the io_context is stopped.
void RunOneUntil(boost::asio::io_context& io, TimePoint end);

/// How a wait ended.
enum class Waited { kDone, kTimeUp, kInterrupted };

/// Handles events of the io_context until the condition holds, which is asked after each of them;
/// without one until the time is up. `interrupted` is asked first.
Waited RunUntil(boost::asio::io_context& io, const std::function<bool()>& condition,
                double within_s, const std::function<bool()>& interrupted);

}  // namespace footing::timer
