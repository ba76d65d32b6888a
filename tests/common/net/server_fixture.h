#pragma once

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/net/framing.h"
#include "common/net/listener.h"
#include "common/net/server.h"
#include "common/net/socket.h"
#include "tests/common/net/io_fixture.h"

namespace footing::transport {

/// A client made of nothing but a framed connection: it does what the test says, no more.
class TestClient {
 public:
  explicit TestClient(Socket socket) {
    FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) {
      v1::Envelope message;
      ASSERT_TRUE(message.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
      messages.push_back(message);
    };
    handlers.on_close = [this](const std::string& reason) { closed = reason; };
    FramedLimits limits;
    limits.max_in_bytes = 1u << 20;
    connection.emplace(std::move(socket), limits, std::move(handlers));
  }

  void Send(const v1::Envelope& message) {
    EXPECT_TRUE(connection->Send(message.SerializeAsString()));
  }
  /// Begins to read: until then it is a stalled reader.
  void Read() { connection->Start(); }

  const v1::Envelope* Find(v1::Envelope::BodyCase body) const {
    const auto found = std::find_if(messages.begin(), messages.end(), [&](const auto& message) {
      return message.body_case() == body;
    });
    return found == messages.end() ? nullptr : &*found;
  }
  std::size_t Count(v1::Envelope::BodyCase body) const {
    return static_cast<std::size_t>(
        std::count_if(messages.begin(), messages.end(),
                      [&](const auto& message) { return message.body_case() == body; }));
  }
  /// Sequences of the ticks received, without the snapshots.
  std::vector<std::uint64_t> Sequences() const {
    std::vector<std::uint64_t> sequences;
    for (const auto& message : messages) {
      if (message.has_tick() && !message.tick().snapshot()) {
        sequences.push_back(message.tick().sequence());
      }
    }
    return sequences;
  }

  std::optional<FramedConnection> connection;
  std::vector<v1::Envelope> messages;
  std::optional<std::string> closed;
};

class ServerFixture : public IoFixture {
 protected:
  static ServerOptions Options() {
    ServerOptions options;
    options.server_id = "test-server";
    options.version = "1.2.3";
    options.channels = {{"status", 16, true}, {"motion", 17, false}, {"raw", 20, false}};
    options.tick_rate_hz = 100;
    return options;
  }

  /// Starts a server on the Unix socket and on TCP.
  void StartServer(ServerOptions options = Options()) {
    options.now_ns = [this] { return now_ns_; };
    ServerHandlers handlers;
    handlers.on_command = [this](const SessionInfo& info,
                                 const v1::Command& command) -> std::optional<v1::CommandResult> {
      commands_.emplace_back(info, command);
      if (answer_later_) return std::nullopt;
      if (on_command_) on_command_();
      v1::CommandResult result;
      result.set_ok(true);
      result.set_message("done " + std::to_string(commands_.size()));
      return result;
    };
    handlers.on_session_end = [this](const SessionInfo& info) { ended_.push_back(info); };
    handlers.on_overload = [this](const OverloadLine& line) { overloads_.push_back(line.text); };
    if (takes_devices_) {
      options.capabilities.push_back("devices");
      handlers.on_device = [this](const SessionInfo& info, std::int64_t,
                                  const v1::DeviceEnvelope& message) {
        devices_.emplace_back(info, message);
      };
    }
    server_ = std::make_unique<Server>(io_, options, handlers);
    ASSERT_TRUE(server_->Listen(UnixAddress()).ok());
    ASSERT_TRUE(server_->Listen(TcpAddress()).ok());
  }

  Socket DialServer(std::size_t listener = 0) {
    std::optional<Result<Socket>> dialled;
    Dial(io_, server_->ListeningOn(listener),
         [&](Result<Socket> result) { dialled.emplace(std::move(result)); });
    EXPECT_TRUE(RunUntil([&] { return dialled.has_value(); }));
    return std::move(*dialled).value();
  }

  std::unique_ptr<TestClient> Connect(std::size_t listener = 0) {
    return std::make_unique<TestClient>(DialServer(listener));
  }

  static v1::Envelope Hello(v1::Role role = v1::ROLE_VIEW) {
    v1::Envelope message;
    message.mutable_hello()->set_protocol_major(1);
    message.mutable_hello()->set_role(role);
    message.mutable_hello()->set_client_name("test");
    return message;
  }

  static v1::Envelope Subscribe(v1::QueuePolicy policy = v1::QUEUE_POLICY_DROP_OLDEST,
                                std::uint32_t queue_ticks = 0) {
    v1::Envelope message;
    message.mutable_subscribe()->set_policy(policy);
    message.mutable_subscribe()->set_queue_ticks(queue_ticks);
    return message;
  }

  /// Hello, Welcome, and the given subscription up to its snapshot.
  std::unique_ptr<TestClient> Subscribed(const v1::Envelope& subscribe, std::size_t listener = 0) {
    auto client = Connect(listener);
    client->Read();
    client->Send(Hello());
    client->Send(subscribe);
    EXPECT_TRUE(RunUntil([&] { return client->Find(v1::Envelope::kTick) != nullptr; }));
    return client;
  }

  /// Publishes one tick of the motion channel; `bytes` makes it that long.
  std::uint64_t PublishMotion(std::size_t bytes = 10) {
    now_ns_ += 10'000'000;
    v1::RawReports raw;
    raw.add_reports()->set_report(std::string(bytes, 'r'));
    v1::MotionSamples motion;
    motion.add_samples()->set_report_count(++count_);
    return server_->Publish(now_ns_,
                            {{17, motion.SerializeAsString()}, {20, raw.SerializeAsString()}});
  }

  std::uint64_t PublishStatus(const std::string& serial) {
    v1::DeviceStatusList list;
    list.add_devices()->set_serial(serial);
    return server_->Publish(now_ns_, {{16, list.SerializeAsString()}});
  }

  bool WaitFor(const TestClient& client, v1::Envelope::BodyCase body) {
    return RunUntil([&] { return client.Find(body) != nullptr; });
  }

  std::int64_t now_ns_ = 1'000'000'000;
  std::uint64_t count_ = 0;
  std::unique_ptr<Server> server_;
  std::vector<std::pair<SessionInfo, v1::Command>> commands_;
  std::function<void()> on_command_;
  bool answer_later_ = false;
  std::vector<SessionInfo> ended_;
  std::vector<std::string> overloads_;
  bool takes_devices_ = false;
  std::vector<std::pair<SessionInfo, v1::DeviceEnvelope>> devices_;
};

}  // namespace footing::transport
