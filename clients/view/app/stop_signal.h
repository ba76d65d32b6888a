#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>

namespace footing::view {

/// Ctrl-C and SIGTERM for a loop that asks whether one came.
class StopSignal {
 public:
  StopSignal() : signals_(io_, SIGINT, SIGTERM) {
    signals_.async_wait([this](const boost::system::error_code& error, int) {
      if (!error) asked_ = true;
    });
  }
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  bool asked() {
    io_.poll();
    return asked_;
  }

 private:
  boost::asio::io_context io_;
  boost::asio::signal_set signals_;
  bool asked_ = false;
};

}  // namespace footing::view
