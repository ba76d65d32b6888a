#include "common/recording/recording_server.h"

#include <google/protobuf/descriptor.h>

#include <array>
#include <chrono>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "common/net/channels_of.h"

namespace footing::playback {
namespace {

constexpr auto kLookForSession = std::chrono::milliseconds(20);
/// From its welcome until a client has subscribed.
constexpr auto kSubscribeTime = std::chrono::milliseconds(200);

/// Channels that say how things stand: their last value is part of every snapshot.
constexpr std::array<std::string_view, 7> kRetainedChannels = {
    "status", "setup", "skeletons", "track", "game", "config", "study"};

transport::ServerOptions OptionsOf(const recording::RecordedSession& session,
                                   const std::string& name, const std::string& version) {
  transport::ServerOptions options;
  options.server_id = name;
  options.version = version;
  options.capabilities = {"recording"};
  std::set<std::uint32_t> fields;
  for (const recording::RecordedServer& server : session.servers()) {
    if (server.name != name) continue;
    options.server_id = server.server_id;
    options.tick_rate_hz = server.tick_rate_hz;
    for (const recording::RecordedTick& tick : server.ticks) {
      for (const recording::RecordedChannel& channel : tick.channels) fields.insert(channel.field);
    }
  }
  for (const std::uint32_t number : fields) {
    const std::string& channel =
        v1::Tick::descriptor()->FindFieldByNumber(static_cast<int>(number))->name();
    bool retained = false;
    for (const std::string_view one : kRetainedChannels) retained = retained || one == channel;
    options.channels.push_back({channel, number, retained});
  }
  return options;
}

v1::CommandResult RefuseCommand(const transport::SessionInfo&, const v1::Command& command) {
  v1::CommandResult result;
  result.set_id(command.id());
  result.set_message("a recording is served here; it takes no commands");
  return result;
}

}  // namespace

RecordingServer::RecordingServer(boost::asio::io_context& io,
                                 const recording::RecordedSession& session, const std::string& name,
                                 const std::string& version)
    : server_(io, OptionsOf(session, name, version), {RefuseCommand, {}}),
      player_(io, session, {name},
              {[this](std::size_t, const v1::Tick& tick) { Publish(tick); },
               [this](const Result<void>& ended) { on_end_(ended); }}),
      wait_(io) {}

void RecordingServer::Start(std::function<void(const Result<void>&)> on_end) {
  on_end_ = std::move(on_end);
  WaitForSession();
}

void RecordingServer::WaitForSession() {
  const bool found = server_.statistics().sessions > 0;
  wait_.expires_after(found ? kSubscribeTime : kLookForSession);
  wait_.async_wait([this, found](const boost::system::error_code& error) {
    if (error) return;
    found ? player_.Start() : WaitForSession();
  });
}

void RecordingServer::Publish(const v1::Tick& tick) {
  server_.Publish(tick.host_ns(), transport::ChannelsOf(tick));
  ++published_;
}

void RecordingServer::Stop(const std::string& reason) {
  wait_.cancel();
  player_.Stop();
  server_.Stop(reason);
}

}  // namespace footing::playback
