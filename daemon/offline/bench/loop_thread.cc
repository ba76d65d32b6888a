#include "daemon/offline/bench/loop_thread.h"

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <memory>

namespace footing::bench {
namespace {

struct Pacer {
  boost::asio::steady_timer timer;
  std::function<void()> tick;
  std::chrono::nanoseconds interval;
  int left;
  std::promise<void> done;
};

void Next(const std::shared_ptr<Pacer>& pacer) {
  if (pacer->left-- == 0) {
    pacer->done.set_value();
    return;
  }
  pacer->timer.expires_at(pacer->timer.expiry() + pacer->interval);
  pacer->timer.async_wait([pacer](const boost::system::error_code& error) {
    if (error) return;
    pacer->tick();
    Next(pacer);
  });
}

}  // namespace

LoopThread::LoopThread() : work_(io_.get_executor()), thread_([this] { io_.run(); }) {}

LoopThread::~LoopThread() { Stop(); }

void LoopThread::Stop() {
  work_.reset();
  io_.stop();
  if (thread_.joinable()) thread_.join();
}

void LoopThread::Do(const std::function<void()>& work) {
  std::promise<void> done;
  boost::asio::post(io_, [&] {
    work();
    done.set_value();
  });
  done.get_future().wait();
}

void LoopThread::Pace(int count, std::int64_t interval_ns, const std::function<void()>& tick) {
  auto pacer = std::make_shared<Pacer>(Pacer{
      boost::asio::steady_timer(io_), tick, std::chrono::nanoseconds(interval_ns), count, {}});
  auto done = pacer->done.get_future();
  boost::asio::post(io_, [pacer] {
    pacer->timer.expires_after(std::chrono::nanoseconds(0));
    Next(pacer);
  });
  done.wait();
}

}  // namespace footing::bench
