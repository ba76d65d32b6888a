#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/listener.h"
#include "common/net/server.h"

namespace footing::bench {

/// The baseline: what a fan-out of bytes costs with Asio and nothing else. One thread, one shared
/// buffer a frame, one async_write a session, TCP_NODELAY; no queue, no handshake.
class BareFanOut {
 public:
  explicit BareFanOut(boost::asio::io_context& io) : io_(io) {}

  Result<void> Listen(const transport::Address& address);
  const transport::Address& address() const { return listener_->address(); }

  void Publish(const std::shared_ptr<const std::string>& frame);
  std::size_t sessions() const { return sockets_.size(); }

 private:
  boost::asio::io_context& io_;
  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::shared_ptr<transport::Socket>> sockets_;
};

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

/// A Unix socket of this run's own.
transport::Address UnixAddress(const std::string& name);
/// Loopback, any free port.
transport::Address TcpAddress();

/// Asks `condition` on the thread every 5 ms; false when it does not hold within 5 s.
bool WaitUntil(LoopThread& thread, const std::function<bool()>& condition);

/// Resident memory of this process.
double ResidentMegabytes();

/// A cheap reader: takes frames and looks into none but a Ping, which it answers. It reads the bare
/// baseline's frames as well as ours.
class Viewer {
 public:
  enum class Greeting { kNone, kSubscribe };

  /// Dials at once. `on_frame` gets every frame but pings; with `reads` false it never reads.
  Viewer(boost::asio::io_context& io, const transport::Address& address, Greeting greeting,
         bool reads, std::function<void(std::string_view)> on_frame);

  bool connected() const { return connection_.has_value() && connection_->open(); }

 private:
  void OnFrame(std::string_view payload);

  std::function<void(std::string_view)> on_frame_;
  std::optional<transport::FramedConnection> connection_;
};

/// Channels and bytes of one footingd tick with five devices: three Wiimotes and two Balance Boards
/// at about 100 reports a second, so one sample and one raw report each, and their features.
std::vector<transport::Channel> SensorChannels();
std::vector<transport::ChannelBytes> ExampleTick();

/// A server for this benchmark: no client is cut because it does not answer.
transport::ServerOptions ServerOptionsFor(double tick_rate_hz, double ring_s);

}  // namespace footing::bench
