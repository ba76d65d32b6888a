#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <future>
#include <initializer_list>
#include <thread>
#include <vector>

namespace footing::bench {

/// A thread that runs an io_context, and a way to do something on it and wait for the result.
class LoopThread {
 public:
  LoopThread();
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  boost::asio::io_context& io() { return io_; }

  /// Ends the thread. What its handlers use may go only after this; may be called twice.
  void Stop();

  /// Runs `work` on the thread; returns when it is done.
  void Do(const std::function<void()>& work);

  /// Calls `tick` on the thread `count` times, every `interval_ns`; returns after the last.
  void Pace(int count, std::int64_t interval_ns, const std::function<void()>& tick);

 private:
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::thread thread_;
};

/// Stops loops at the end of its scope: declare it behind what they serve.
class StopsAtEnd {
 public:
  explicit StopsAtEnd(std::initializer_list<LoopThread*> threads) : threads_(threads) {}
  ~StopsAtEnd() {
    for (LoopThread* thread : threads_) thread->Stop();
  }
  StopsAtEnd(const StopsAtEnd&) = delete;
  StopsAtEnd& operator=(const StopsAtEnd&) = delete;

 private:
  std::vector<LoopThread*> threads_;
};

}  // namespace footing::bench
