#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "clients/view/app/play_session.h"
#include "clients/view/scene/model.h"
#include "clients/view/scene/tally.h"
#include "common/runtime/service_manager.h"

namespace footing::view {

/// Times of a window's pictures.
struct PictureTimes {
  scene::Latencies interval;  ///< From the beginning of one picture to that of the next.
  scene::Latencies drawing;   ///< From its beginning until it is shown, without the wait after it.
  std::int64_t last_begun_ns = 0;

  void Add(std::int64_t begun_ns, std::int64_t shown_ns);
};

/// One JSON object: the summary of a live view, and beside it `playback` with the position and all
/// trials, failures and tasks of what is played; of two recordings the second one as `beside`.
/// `seconds` is how long the viewer ran, `times` are those of its window, if it has one.
std::string PlaySummary(const PlaySession& session, double seconds, const PictureTimes& times = {});

/// The state at the head's position, in lines for a terminal: position, trials, and of each
/// recording what StatusScreen says of a live view.
std::vector<std::string> PlayScreenText(const PlaySession& session);
/// State of the session in one line.
std::string PlayLine(const PlaySession& session);

/// Ctrl-C and SIGTERM for a loop that asks whether one came.
class StopSignal {
 public:
  bool asked() {
    io_.poll();
    return end_.asked();
  }

 private:
  boost::asio::io_context io_;
  service_manager::ProgramEnd end_{io_};
};

/// Summary of a run, as one JSON object.
std::string Summary(const scene::Model& model, double seconds, const PictureTimes& times = {});

}  // namespace footing::view
