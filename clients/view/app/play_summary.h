#pragma once

#include <csignal>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

#include "clients/view/app/play_session.h"
#include "clients/view/scene/model.h"

namespace footing::view {

/// One JSON object: the summary of a live view, and beside it `playback` with the position and all
/// trials, failures and tasks of what is played; of two recordings the second one as `beside`.
/// `seconds` is how long the viewer ran.
std::string PlaySummary(const PlaySession& session, double seconds);

/// The state at the head's position, in lines for a terminal: position, trials, and of each
/// recording what StatusScreen says of a live view.
std::vector<std::string> PlayScreenText(const PlaySession& session);
/// State of the session in one line.
std::string PlayLine(const PlaySession& session);

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

/// Summary of a run, as one JSON object.
std::string Summary(const scene::Model& model, double seconds);

}  // namespace footing::view
