#include "common/net/client.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <string>

#include "common/net/framing.h"
#include "common/runtime/timer.h"
#include "tests/fuzz/message.h"
#include "tests/fuzz/simulated_time.h"

/// A client whose server sends anything at any time: bytes, whole messages of every kind, or
/// nothing for seconds; which ends the connection and is there again. Every command gets exactly
/// one answer, the clock offset stays a number, and what the client sends is frames of its
/// messages.
namespace footing::fuzz {
namespace {

/// Where the client dials.
struct Listening {
  Listening() {
    std::string folder = "/tmp/footing-fuzz-XXXXXX";
    Expect(mkdtemp(folder.data()) != nullptr);
    path = folder + "/s";
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    descriptor = ::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    Expect(::bind(descriptor, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    Expect(::listen(descriptor, 64) == 0);
  }
  ~Listening() {
    unlink(path.c_str());
    rmdir(path.substr(0, path.rfind('/')).c_str());
  }
  std::string path;
  int descriptor;
};

class Dialling {
 public:
  explicit Dialling(std::uint8_t how) {
    static const Listening listening;
    listening_ = listening.descriptor;
    transport::ClientOptions options;
    options.address.path = listening.path;
    options.client_name = "fuzzed";
    options.max_message_bytes = 2048;
    if ((how & 1) != 0) options.policy = v1::QUEUE_POLICY_LATEST;
    options.from_ring_start = (how & 2) != 0;
    transport::ClientHandlers handlers;
    handlers.on_state = [this](transport::LinkState, const std::string& why) {
      Expect(!why.empty());
      if (stop_at_ == 1) client_->Stop();
    };
    handlers.on_tick = [this](const v1::Tick&) {
      if (stop_at_ == 2) client_->Stop();
    };
    client_.emplace(io_, options, handlers);
    client_->Start();
    Accept();
  }
  ~Dialling() {
    client_.reset();
    Expect(answered_ == commands_);
    RunFor(io_, 0);
    timer::DropWaits();
    server_.Close();
    Take();
  }

  void Step(Input& input) {
    switch (input.Byte() % 10) {
      case 0: {
        const Bytes bytes = input.String();
        return server_.Write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      }
      case 1:
      case 2: {
        v1::Envelope message;
        Fill(input, message);
        return Send(message);
      }
      case 3:
        return Welcome(input.Byte());
      case 4:
        return Answer();
      case 5:
        RunFor(io_, time_.Take(0.1 * input.Byte()));
        return Accept();
      case 6: {
        ++commands_;
        v1::Command command;
        command.set_deadline_ms(input.Byte() * 10);
        return client_->Send(command, [this](const v1::CommandResult&) { ++answered_; });
      }
      case 7:
        return client_->Refill(input.Byte(), input.Byte());
      case 8:
        server_.Close();
        RunFor(io_, time_.Take(2));
        return Accept();
      default:
        stop_at_ = input.Byte() % 16;
    }
  }

  void Check() const {
    const transport::ClockOffset offset = client_->clock();
    Expect(!offset.valid || offset.uncertainty_ns >= 0);
  }

 private:
  /// A connection that waits is taken.
  void Take() {
    const int descriptor = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (descriptor < 0) return;
    server_.Take(descriptor);
    splitter_ = transport::FrameSplitter(64u << 10);
  }
  void Accept() {
    RunFor(io_, 0);
    Take();
    RunFor(io_, 0);
  }

  void Send(const v1::Envelope& message) {
    server_.Write(transport::Frame(message.SerializeAsString()));
    RunFor(io_, 0);
  }

  void Welcome(std::uint8_t how) {
    v1::Envelope message;
    message.mutable_welcome()->set_server_id("s");
    message.mutable_welcome()->set_epoch(how % 2);
    Send(message);
    if ((how & 2) != 0) {
      for (int i = 0; i < 6; ++i) Answer();
    }
  }

  /// As a server would.
  void Answer() {
    RunFor(io_, 0);
    const auto fed = splitter_.Feed(server_.Read(), [this](std::string_view payload) {
      v1::Envelope asked, answer;
      Expect(asked.ParseFromArray(payload.data(), static_cast<int>(payload.size())));
      Expect(asked.has_hello() || asked.has_ping() || asked.has_pong() || asked.has_subscribe() ||
             asked.has_command() || asked.has_refill());
      if (asked.has_ping()) {
        answer.mutable_pong()->set_id(asked.ping().id());
        answer.mutable_pong()->set_t0_ns(asked.ping().t0_ns());
        answer.mutable_pong()->set_t1_ns(asked.ping().t0_ns() + 1000);
        answer.mutable_pong()->set_t2_ns(asked.ping().t0_ns() + 2000);
      }
      if (asked.has_subscribe()) answer.mutable_subscribed();
      if (asked.has_command()) answer.mutable_command_result()->set_id(asked.command().id());
      if (answer.body_case() != v1::Envelope::BODY_NOT_SET) {
        server_.Write(transport::Frame(answer.SerializeAsString()));
      }
      return true;
    });
    Expect(fed.ok());
    RunFor(io_, 0);
  }

  boost::asio::io_context io_;
  int listening_ = -1;
  TimeBudget time_;
  RawPeer server_;
  std::optional<transport::Client> client_;
  transport::FrameSplitter splitter_{64u << 10};
  int commands_ = 0, answered_ = 0, stop_at_ = 0;
};

}  // namespace
}  // namespace footing::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace footing;
  fuzz::FollowSimulatedTime();
  fuzz::Input input(data, size);
  fuzz::Dialling dialling(input.Byte());
  while (!input.empty()) {
    dialling.Step(input);
    dialling.Check();
  }
  return 0;
}
