#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <functional>

#include "common/runtime/timer.h"

namespace footing::service_manager {

/// SIGINT and SIGTERM end a service in order: its clients are served to the end, for at most 2 s or
/// until a second signal. SIGHUP lets it read its config again, but for the one that comes with the
/// end of its terminal, which ends it, too. Started with nohup it outlives its terminal.
class ServiceSignals {
 public:
  struct Handlers {
    /// Ends the service's work; `done` when its clients have gone.
    std::function<void(int signal, std::function<void()> done)> stop;
    std::function<void()> reload;
  };

  /// The io_context is stopped at the end.
  ServiceSignals(boost::asio::io_context& io, Handlers handlers);
  ServiceSignals(const ServiceSignals&) = delete;
  ServiceSignals& operator=(const ServiceSignals&) = delete;

 private:
  void Wait();
  void OnSignal(int signal);

  boost::asio::io_context& io_;
  boost::asio::signal_set signals_;
  timer::Timer patience_;
  Handlers handlers_;
  const bool ends_with_terminal_;
  bool stopping_ = false;
};

}  // namespace footing::service_manager
