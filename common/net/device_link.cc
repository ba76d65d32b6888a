#include "common/net/device_link.h"

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/net/address.h"
#include "common/net/client.h"
#include "common/net/framing.h"
#include "common/net/limits.h"
#include "common/net/socket.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "common/wire/wire.h"

namespace footing::device_link {

bool BySession(const transport::Address& to) {
  return to.kind == transport::Address::Kind::kTls ||
         (to.kind == transport::Address::Kind::kTcp && !StaysOnThisHost(to));
}

namespace {

constexpr auto kRedial = std::chrono::milliseconds(250);

/// The command that starts a footingd which listens there: by default it does at the user's own.
std::string FootingdFor(const transport::Address& to) {
  if (to.Text() == transport::DefaultAddress("devices").Text()) return "footingd";
  const std::string in_clear = to.kind == transport::Address::Kind::kTcp ? " --insecure-lan" : "";
  return "footingd --source stream:" + to.Text() +
         (BySession(to) ? in_clear + " --set token_file=FILE" : "");
}

}  // namespace

class DeviceLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, Options options)
      : io_(io), options_(std::move(options)), redial_(io) {}

  void Start() { BySession(options_.to) ? OpenSession() : Dial(); }

  bool Send(const v1::DeviceEnvelope& message) {
    const bool taken = session_ ? open_ && session_->SendDevice(message)
                                : open_ && connection_->Send(message.SerializeAsString());
    ++(taken ? sent_ : dropped_);
    return taken;
  }

  void Stop(const std::string& reason) {
    stopped_ = true;
    redial_.cancel();
    if (session_) session_->Finish(reason);
    if (connection_) connection_->Finish({}, reason);
  }

  bool open() const { return open_; }
  bool was_open() const { return was_open_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t dropped() const { return dropped_; }

  Error NeverOpen() const {
    if (!refusal_.empty()) return Failure(refusal_);
    return NoDevice("no footingd listened for devices on " + options_.to.Text() +
                    "; start it with: " + FootingdFor(options_.to));
  }

 private:
  void OpenSession() {
    transport::ClientOptions client;
    client.address = options_.to;
    client.client_name = options_.client_name;
    client.role = v1::ROLE_CONTROL;
    client.attaches_devices = true;
    client.max_queued_frames = options_.max_queued_frames;
    transport::ClientHandlers handlers;
    handlers.on_device = [this](const v1::DeviceEnvelope& message) { OnMessage(message); };
    handlers.on_state = [this](transport::LinkState state, const std::string& why) {
      OnState(state, why);
    };
    session_.emplace(io_, std::move(client), std::move(handlers));
    session_->Start();
  }

  void OnState(transport::LinkState state, const std::string& why) {
    const auto self = shared_from_this();  // A handler may let the link go.
    switch (state) {
      case transport::LinkState::kStale:
        return;
      case transport::LinkState::kLive:
        if (!open_) OnOpen();
        return;
      case transport::LinkState::kRefused:
      case transport::LinkState::kConnecting:
        refusal_ = state == transport::LinkState::kRefused ? why : "";
        OnLost();
        if (!stopped_) SayWaiting(why, "start footingd there with: ");
        return;
    }
  }

  void Dial() {
    transport::Dial(io_, options_.to, [weak = weak_from_this()](Result<transport::Socket> socket) {
      const auto self = weak.lock();
      if (!self || self->stopped_) return;
      if (socket) {
        self->Open(std::move(socket).value());
      } else {
        self->WaitFor(socket.error().message);
      }
    });
  }

  void Open(transport::Socket socket) {
    transport::FramedLimits limits;
    limits.max_in_bytes = limits.max_out_bytes = transport::kMaxDeviceBytes;
    limits.max_queued_frames = options_.max_queued_frames;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { OnFrame(payload); };
    handlers.on_close = [this](const std::string& reason) { OnClose(reason); };
    connection_ = std::make_unique<transport::FramedConnection>(std::move(socket), limits,
                                                                std::move(handlers));
    connection_->Start();
    OnOpen();
  }

  void OnOpen() {
    if (refusal_.empty()) waits_for_.clear();
    open_ = was_open_ = true;
    if (options_.on_open) options_.on_open();
  }

  void OnFrame(std::string_view payload) {
    if (RefusedAsClient(payload)) return;
    v1::DeviceEnvelope message;
    if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return;
    OnMessage(message);
  }

  /// Whether this is the answer of a port for clients, such as one that speaks TLS. No output of
  /// the device socket reads as one: its second field is a number, not a text.
  bool RefusedAsClient(std::string_view payload) {
    v1::Envelope answer;
    if (!options_.to.OverTcp() ||
        !answer.ParseFromArray(payload.data(), static_cast<int>(payload.size())) ||
        answer.refused().message().empty()) {
      return false;
    }
    refusal_ = options_.to.Text() + " refused: " + answer.refused().message();
    was_open_ = false;
    return true;
  }

  void OnMessage(const v1::DeviceEnvelope& message) {
    if (message.has_refused()) {
      log::Error("footingd: " + message.refused().reason());
      if (options_.on_refused) options_.on_refused(message.refused());
      return;
    }
    if (options_.on_message) options_.on_message(message);
  }

  void OnClose(const std::string& reason) {
    const auto self = shared_from_this();  // A handler may let the link go.
    connection_.reset();
    OnLost();
    if (!stopped_) WaitFor(reason);
  }

  void OnLost() {
    if (std::exchange(open_, false) && !stopped_ && options_.on_close) options_.on_close();
  }

  void WaitFor(const std::string& why) {
    SayWaiting(refusal_.empty() ? "waiting for footingd: " + why : refusal_, "start it with: ");
    redial_.After(kRedial, [this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (!stopped_) Dial();
    });
  }

  /// `start` goes before the command that starts a footingd; who is refused has found one.
  void SayWaiting(const std::string& line, const std::string& start) {
    if (std::exchange(waits_for_, line) == line) return;
    const std::string remedy = refusal_.empty() ? start + FootingdFor(options_.to) : "";
    log::Info(line + transport::RemedyFor(line, remedy));
  }

  boost::asio::io_context& io_;
  const Options options_;
  timer::Timer redial_;
  std::optional<transport::Client> session_;
  std::unique_ptr<transport::FramedConnection> connection_;
  std::string waits_for_;
  std::string refusal_;  ///< Why footingd refuses the session; empty: it does not.
  std::uint64_t sent_ = 0, dropped_ = 0;
  bool open_ = false, stopped_ = false, was_open_ = false;
};

DeviceLink::DeviceLink(boost::asio::io_context& io, Options options)
    : implementation_(std::make_shared<Implementation>(io, std::move(options))) {}
DeviceLink::~DeviceLink() = default;

void DeviceLink::Start() { implementation_->Start(); }
bool DeviceLink::Send(const v1::DeviceEnvelope& message) { return implementation_->Send(message); }
bool DeviceLink::Send(const stream::HandFrame& frame) {
  v1::DeviceEnvelope message;
  *message.mutable_hand_frame() = wire::ToProto(frame);
  return Send(message);
}
void DeviceLink::Stop(const std::string& reason) { implementation_->Stop(reason); }
bool DeviceLink::open() const { return implementation_->open(); }
bool DeviceLink::was_open() const { return implementation_->was_open(); }
Error DeviceLink::NeverOpen() const { return implementation_->NeverOpen(); }
std::uint64_t DeviceLink::sent() const { return implementation_->sent(); }
std::uint64_t DeviceLink::dropped() const { return implementation_->dropped(); }

}  // namespace footing::device_link
