#include "common/net/session.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <string>

#include "common/net/framing.h"
#include "common/runtime/clock.h"
#include "common/runtime/timer.h"
#include "tests/fuzz/message.h"
#include "tests/fuzz/simulated_time.h"

/// The server's side of a connection whose client sends anything at any time: bytes, whole messages
/// of every kind, or nothing for seconds, while ticks are published and commands answered. What
/// comes back is frames of the server's messages, and once the client has gone the session ends.
namespace footing::fuzz {
namespace {

using transport::Session;
using transport::Shared;

constexpr const char* kToken = "0123456789abcdef";

transport::ServerOptions Options(std::uint8_t how) {
  transport::ServerOptions options;
  options.server_id = "fuzzed";
  options.version = "1";
  options.channels = {{"status", 16, true}, {"motion", 17, false}, {"raw", 20, false}};
  options.ring_s = 1;
  options.max_queue_ticks = 8;
  options.max_message_in_bytes = 2048;
  options.max_message_out_bytes = 4096;
  options.sessions.session_messages_per_s = (how & 2) != 0 ? 100000 : 10;
  if ((how & 4) != 0) options.token = kToken;
  if ((how & 8) != 0) options.sessions.max_control_sessions = 0;
  options.insecure_lan = (how & 16) != 0;
  return options;
}

/// A connected pair: the server's end and the client's. Over TCP the client is nobody known.
std::array<int, 2> Pair(bool tcp) {
  std::array<int, 2> pair{-1, -1};
  if (!tcp) {
    Expect(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair.data()) == 0);
    return pair;
  }
  static const int listening = [] {
    const int made = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    Expect(::bind(made, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    Expect(::listen(made, 8) == 0);
    return made;
  }();
  sockaddr_in address{};
  socklen_t size = sizeof address;
  Expect(getsockname(listening, reinterpret_cast<sockaddr*>(&address), &size) == 0);
  pair[1] = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const linger at_once{1, 0};  // Or ports would wait for a minute each.
  setsockopt(pair[1], SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  Expect(::connect(pair[1], reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
  pair[0] = ::accept(listening, nullptr, nullptr);
  Expect(pair[0] >= 0);
  return pair;
}

class Served {
 public:
  explicit Served(std::uint8_t how) : shared_(io_.get_executor(), Options(how), Handlers()) {
    shared_.epoch = 7;
    const bool tcp = (how & 1) != 0;
    const auto [ours, theirs] = Pair(tcp);
    client_.Take(theirs);
    transport::PlainSocket plain(io_);
    plain.assign(boost::asio::generic::stream_protocol(tcp ? AF_INET : AF_UNIX, 0), ours);
    session_ = std::make_shared<Session>(transport::Socket(std::move(plain)), 1, shared_,
                                         [this](Session&) { ended_ = true; });
    if ((how & 224) == 224) {
      session_->StartRefused(v1::Refused::REASON_TOO_MANY_SESSIONS, "full");
    } else {
      session_->Start();
    }
  }
  ~Served() {
    session_.reset();
    timer::DropWaits();
  }

  void Step(Input& input) {
    switch (input.Byte() % 10) {
      case 0: {
        const Bytes bytes = input.String();
        return client_.Write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }
      case 1:
      case 2: {
        v1::Envelope message;
        Fill(input, message);
        return Send(message);
      }
      case 3:
        return Greet(input.Byte());
      case 4:
        return Subscribe(input);
      case 5:
        return Publish(input.Byte() % 32, input.Byte());
      case 6:
        return RunFor(io_, time_.Take(0.1 * input.Byte()), [this] { return ended_; });
      case 7:
        return Look();
      case 8:
        return Answer(input.Byte());
      default:
        return Tell(input.Byte());
    }
  }

  /// The client reads on, and is gone.
  void End() {
    client_.EndWriting();
    for (int i = 0; i < 100 && !ended_; ++i) {
      RunFor(io_, 0.5, [this] { return ended_; });
      Look();
    }
    Expect(ended_);
  }

 private:
  transport::ServerHandlers Handlers() {
    transport::ServerHandlers handlers;
    handlers.on_device = [](const transport::SessionInfo& info, std::int64_t,
                            const v1::DeviceEnvelope& message) {
      Expect(info.role >= v1::ROLE_CONTROL);
      Expect(message.ByteSizeLong() <= transport::kMaxDeviceBytes);
    };
    handlers.on_command = [this](const transport::SessionInfo& info,
                                 const v1::Command& command) -> std::optional<v1::CommandResult> {
      Expect(info.role >= v1::ROLE_CONTROL);
      last_command_ = command.id();
      if (command.id() % 2 == 0) return std::nullopt;
      v1::CommandResult result;
      result.set_ok(true);
      return result;
    };
    handlers.on_overload = [](const transport::OverloadLine& line) {
      Expect(line.text.size() < 1000);
    };
    return handlers;
  }

  void Send(const v1::Envelope& message) {
    client_.Write(transport::Frame(message.SerializeAsString()));
    RunFor(io_, 0);
  }

  void Greet(std::uint8_t how) {
    v1::Envelope message;
    message.mutable_hello()->set_protocol_major(1);
    message.mutable_hello()->set_role(static_cast<v1::Role>(how % 6));
    if ((how & 64) != 0) message.mutable_hello()->set_token((how & 128) != 0 ? kToken : "wrong");
    Send(message);
  }

  void Subscribe(Input& input) {
    v1::Envelope message;
    v1::Subscribe& wish = *message.mutable_subscribe();
    const std::uint8_t how = input.Byte();
    wish.set_policy(static_cast<v1::QueuePolicy>(how % 5));
    wish.set_queue_ticks(how / 64);
    if ((how & 8) != 0) wish.add_channels("motion");
    if ((how & 16) != 0) wish.set_max_hz(input.Byte());
    if ((how & 32) != 0) {
      wish.set_from_sequence(input.Byte());
      wish.set_from_epoch(7 + input.Byte() % 2);
    }
    Send(message);
  }

  void Publish(int count, std::uint8_t how) {
    for (int i = 0; i < count; ++i) {
      std::vector<transport::ChannelBytes> channels;
      if ((how & 1) != 0) channels.push_back({16, "\n\x02\x08\x01"});
      if ((how & 2) != 0) channels.push_back({17, ""});
      v1::RawReports raw;
      raw.add_reports()->set_report(std::string(2 * how, 'r'));
      if ((how & 4) != 0) channels.push_back({20, raw.SerializeAsString()});
      const auto tick = shared_.publication.Publish(
          {shared_.publication.last_sequence() + 1, clock::MonotonicNs() + i * 10'000'000},
          channels);
      session_->Offer(tick);
      shared_.publication.Keep(tick);
    }
  }

  void Answer(std::uint8_t how) {
    v1::CommandResult result;
    result.set_id((how & 1) != 0 ? last_command_ : how);
    session_->Answer(result);
  }

  void Tell(std::uint8_t how) {
    if (how < 32) return session_->Drain("over");
    if (how < 40) return session_->End("over");
    session_->Notify(v1::Notice::KIND_TICKS_LATE, "late", how);
    Expect(session_->Stats().client_name.size() <= 64);
  }

  void Look() {
    RunFor(io_, 0);
    const auto fed = splitter_.Feed(client_.Read(), [this](std::string_view payload) {
      v1::Envelope message;
      Expect(message.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
      Expect(!last_word_);  // Nothing follows it.
      switch (message.body_case()) {
        case v1::Envelope::kHello:
        case v1::Envelope::kSubscribe:
        case v1::Envelope::kRefill:
        case v1::Envelope::kCommand:
        case v1::Envelope::BODY_NOT_SET:
          Expect(false);
          break;
        default:
          last_word_ = message.has_refused() || message.has_goodbye();
      }
      return true;
    });
    Expect(fed.ok());
  }

  boost::asio::io_context io_;
  Shared shared_;
  RawPeer client_;
  TimeBudget time_;
  std::shared_ptr<Session> session_;
  transport::FrameSplitter splitter_{4096};
  std::uint64_t last_command_ = 0;
  bool ended_ = false;
  bool last_word_ = false;
};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::FollowSimulatedTime();
  fuzz::Input input(data, size);
  fuzz::Served served(input.Byte());
  while (!input.empty()) served.Step(input);
  served.End();
  return 0;
}
