#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

#include "common/runtime/timer.h"

/// Reports of a program to the service manager that started it (sd_notify(3)), and what it got
/// from it (sd_listen_fds(3)). Started by hand, nothing of this happens. And the signals that end
/// a program.
namespace footing::service_manager {

/// The descriptor of the listening socket that the manager passed under this name
/// (FileDescriptorName= of the socket unit); -1 when there is none.
int PassedSocket(const std::string& name);

/// Says that the program is ready, that it ends, and, where the unit has WatchdogSec=, that it is
/// alive: twice in each interval, while its io thread turns and no other thread is stuck.
class Notifier {
 public:
  /// `what_is_stuck` names a thread that has not come round its loop for too long; empty: none.
  Notifier(boost::asio::io_context& io, std::function<std::string()> what_is_stuck)
      : timer_(io), what_is_stuck_(std::move(what_is_stuck)) {}

  /// `status` is what `systemctl status` shows.
  void Ready(const std::string& status);
  void Stopping();

 private:
  void Beat();
  void Report();

  timer::Timer timer_;
  std::chrono::microseconds interval_{0};
  std::function<std::string()> what_is_stuck_;
  std::string status_;
  std::string stuck_;  ///< As it was said.
};

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

/// Ends a program that runs until it is stopped: SIGINT (Ctrl-C) or SIGTERM, or when its time is
/// up.
class ProgramEnd {
 public:
  /// `on_signal` is called once, on the io_context.
  explicit ProgramEnd(boost::asio::io_context& io, std::function<void()> on_signal = {});
  ProgramEnd(const ProgramEnd&) = delete;
  ProgramEnd& operator=(const ProgramEnd&) = delete;

  /// Calls `on_time_up` after this time, in place of an earlier such call; 0: never.
  void After(double seconds, std::function<void()> on_time_up);
  /// Neither calls any more, and the io_context does not wait for them.
  void cancel();
  /// A signal came.
  bool asked() const { return asked_; }

 private:
  boost::asio::signal_set signals_;
  timer::Timer limit_;
  bool asked_ = false;
};

}  // namespace footing::service_manager
