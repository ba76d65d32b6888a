#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <google/protobuf/message.h>
#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/server.h"
#include "common/recording/mcap_records.h"
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

/// Serves one server of a recording in that server's place: clients get what they would have got.
/// It plays from the first session on, once; commands are refused. Everything runs on the
/// io_context's one thread.
class RecordingServer {
 public:
  /// `name` is that of a server in the recording; `session` must outlive this object.
  RecordingServer(boost::asio::io_context& io, const recording::RecordedSession& session,
                  const std::string& name, const std::string& version);

  Result<void> Listen(const transport::Address& address) { return server_.Listen(address); }
  transport::Address ListeningOn(std::size_t index) const { return server_.ListeningOn(index); }

  /// Waits for the first session. `on_end` is called when everything was sent, or with the reason
  /// why the recording cannot be read on.
  void Start(std::function<void(const Result<void>&)> on_end);
  /// Says goodbye to every session and closes.
  void Stop(const std::string& reason);

  double duration_s() const { return player_.duration_s(); }
  std::uint64_t published() const { return published_; }

 private:
  void WaitForSession();
  void Publish(const v1::Tick& tick);

  transport::Server server_;
  TickPlayer player_;
  timer::Timer wait_;
  std::function<void(const Result<void>&)> on_end_;
  std::uint64_t published_ = 0;
};

/// Sessions kept of one server: every tick is compared with each. Later ones are left out.
inline constexpr std::size_t kMostSessions = 10'000;

/// A connection of the recorder: what was made before it came later. Nanoseconds of both clocks.
struct RecordedWelcome {
  std::int64_t server_ns = 0;
  std::int64_t recorder_ns = 0;
};

/// Description of one server in a recording.
struct RecordedServer {
  std::string name;
  std::int64_t offset_ns = 0;   ///< Its clock minus the recorder's.
  bool clock_measured = false;  ///< `offset_ns` is of "clock".
  std::vector<RecordedWelcome> welcomes;
  std::map<std::string, std::uint16_t> channels;  ///< By name, to the file's channel id.
};

/// Takes the metadata "clock": how the clocks stood at the recording's end.
void TakeClock(const mcap::TextMap& values, RecordedServer& server);

/// Takes the metadata "session" of a new connection. Until a clock is taken, the greeting of
/// another host gives the offset, late by the time it was under way. Gives UNIX time less the
/// recorder's clock; nothing when it does not say.
std::optional<std::int64_t> TakeSession(const mcap::TextMap& values, RecordedServer& server);

/// A tick made at `host_ns` and recorded at `recorded_ns` came as it was made.
bool IsLive(const RecordedServer& server, std::int64_t host_ns, std::int64_t recorded_ns);

/// Moves every instant of a server's clock in the message by `shift_ns`: the int64 fields, at any
/// depth, whose names end in _ns, except those of other clocks (age_ns, true_ns, wall_time_ns).
/// Zero means unknown and stays, and so does what no clock comes to. `shift_ns` is the difference
/// of two instants.
void ShiftStamps(google::protobuf::Message& message, std::int64_t shift_ns);

}  // namespace footing::playback
