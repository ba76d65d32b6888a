#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/foxglove/scene.h"
#include "footing/v1/session.pb.h"

namespace footing::web {

/// The names of Foxglove's WebSocket protocol, which are of one meaning; the first that a client
/// offers is the one it gets. Empty: it offers neither.
std::string_view FoxgloveProtocol(std::string_view offered);

/// The server's side of Foxglove's WebSocket protocol for one viewer, without its connection: the
/// scene of all servers as channels in Protobuf. Who reads slowly gets the newest of each channel.
/// Source: github.com/foxglove/ws-protocol, docs/spec.md.
class FoxgloveFeed {
 public:
  static constexpr std::size_t kMostSubscriptions = 256;
  /// Messages of the log that wait; the oldest go first.
  static constexpr std::size_t kMostLogs = 100;

  struct Message {
    bool is_text = false;
    std::string bytes;
  };

  /// `session` is another one for each start of the program.
  explicit FoxgloveFeed(const std::string& session);

  /// A text of the viewer. InvalidData where it is none of the protocol; what the protocol has and
  /// this server has not is answered with a status.
  Result<void> Take(std::string_view text);
  /// A tick of a server, whose name its topics have.
  void OnTick(const std::string& server, const v1::Tick& tick, const recording::Stamp& stamp);
  /// The next message to the viewer.
  std::optional<Message> Next();

 private:
  struct Channel {
    std::uint32_t id = 0;
    bool is_log = false;
    std::string newest;  ///< Behind the subscription's number: time and payload.
  };
  struct Subscription {
    Channel* channel = nullptr;
    std::deque<std::string> waiting;  ///< One, but for the log.
  };

  Result<void> Write(const std::string& topic, const google::protobuf::Message& message,
                     const recording::Stamp& stamp);
  Channel& Advertise(const std::string& topic, const google::protobuf::Message& message);
  void Subscribe(std::uint32_t id, std::uint32_t channel);
  void Status(const std::string& words);

  foxglove_scene::Scene scene_;
  std::map<std::string, Channel> channels_;  ///< By topic.
  std::map<std::uint32_t, Subscription> subscriptions_;
  std::deque<std::string> texts_;
  std::uint32_t sent_last_ = 0;  ///< The subscription whose turn it was.
};

}  // namespace footing::web
