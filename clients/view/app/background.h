#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <memory>
#include <thread>
#include <vector>

#include "clients/view/app/feed.h"
#include "clients/view/scene/show.h"
#include "common/exchange/bounded_queue.h"
#include "common/exchange/flag.h"
#include "common/exchange/latest.h"

namespace footing::view {

/// The io thread: receives ticks there and hands them to the render thread through a bounded
/// queue. Ctrl-C and SIGTERM raise a flag.
class Background {
 public:
  explicit Background(const Options& options);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Render thread: takes in all that has come.
  void Drain(scene::Show& show);
  /// Sends a command to the simulation, from the io thread.
  void SendToSimulation(v1::Command command);
  bool stop_asked() const { return stop_.raised(); }

 private:
  void RunOnIoThread();

  boost::asio::io_context io_;
  boost::asio::signal_set signals_;
  exchange::BoundedQueue<scene::Update> updates_;
  std::vector<std::unique_ptr<exchange::Latest<scene::LinkReport>>> links_;
  exchange::Flag stop_;
  Feed feed_;
  std::thread thread_;
};

}  // namespace footing::view
