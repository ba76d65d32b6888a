#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <string>

/// What a program reports to the service manager that started it (sd_notify(3)), and what it got
/// from it (sd_listen_fds(3)). Started by hand, nothing of this happens.
namespace footing::service_manager {

/// The descriptor of the listening socket that the manager passed under this name
/// (FileDescriptorName= of the socket unit); -1 when there is none.
int PassedSocket(const std::string& name);

/// Says that the program is ready, that it ends, and, where the unit has WatchdogSec=, that its io
/// thread is alive: twice in each interval.
class Notifier {
 public:
  explicit Notifier(boost::asio::io_context& io) : timer_(io) {}

  /// `status` is what `systemctl status` shows.
  void Ready(const std::string& status);
  void Stopping();

 private:
  void Beat();

  boost::asio::steady_timer timer_;
  std::chrono::microseconds interval_{0};
};

}  // namespace footing::service_manager
