#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/recording/recorded_session.h"
#include "common/runtime/timer.h"
#include "footing/v1/session.pb.h"

namespace footing::playback {

/// Plays the ticks of a recording's servers at their recorded pace, each with its stamps moved to
/// the present: they look as if they were made now. What several servers sent keeps its order.
/// Everything runs on the io_context's one thread.
class TickPlayer {
 public:
  struct Handlers {
    /// `server` counts in names().
    std::function<void(std::size_t server, const v1::Tick&)> on_tick;
    /// The last tick was played; or, with a reason, a tick could not be read.
    std::function<void(const Result<void>&)> on_end;
  };

  /// Plays the servers of these names, all starts of each; names that are not in the recording play
  /// nothing. `session` must outlive the player.
  TickPlayer(boost::asio::io_context& io, const recording::RecordedSession& session,
             std::vector<std::string> names, Handlers handlers);
  TickPlayer(const TickPlayer&) = delete;
  TickPlayer& operator=(const TickPlayer&) = delete;

  /// From the first tick on. Call once.
  void Start();
  /// No handler is called from now on.
  void Stop() { timer_.cancel(); }

  const std::vector<std::string>& names() const { return names_; }
  double duration_s() const;
  std::size_t ticks() const { return due_.size(); }

 private:
  /// When a tick is played, on the recording's clock.
  struct Due {
    std::int64_t time_ns = 0;
    std::size_t server = 0;
    const recording::RecordedTick* tick = nullptr;
  };

  void Schedule(std::size_t server, const std::vector<const recording::RecordedTick*>& ticks);
  void PlayNext();
  void End();

  timer::Timer timer_;
  std::vector<std::string> names_;
  Handlers handlers_;
  std::vector<Due> due_;
  std::size_t next_ = 0;
  std::int64_t shift_ns_ = 0;  ///< From the recording's clock to this host's.
  timer::TimePoint start_;
};

}  // namespace footing::playback
