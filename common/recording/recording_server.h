#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <string>

#include "common/recording/tick_player.h"
#include "common/recording/recorded_session.h"
#include "common/base/result.h"
#include "common/runtime/timer.h"
#include "common/net/server.h"

namespace footing::playback {

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

}  // namespace footing::playback
