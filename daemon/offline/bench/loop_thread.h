#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <functional>
#include <future>
#include <thread>

namespace footing::bench {

/// A thread that runs an io_context, and a way to do something on it and wait for the result.
class LoopThread {
 public:
  LoopThread();
  ~LoopThread();
  LoopThread(const LoopThread&) = delete;
  LoopThread& operator=(const LoopThread&) = delete;

  boost::asio::io_context& io() { return io_; }

  /// Runs `work` on the thread; returns when it is done.
  void Do(const std::function<void()>& work);

  /// Calls `tick` on the thread `count` times, every `interval_ns`; returns after the last.
  void Pace(int count, std::int64_t interval_ns, const std::function<void()>& tick);

 private:
  boost::asio::io_context io_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::thread thread_;
};

}  // namespace footing::bench
