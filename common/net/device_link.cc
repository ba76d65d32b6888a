#include "common/net/device_link.h"

#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "common/net/address.h"
#include "common/net/framing.h"
#include "common/net/socket.h"
#include "common/runtime/log.h"
#include "common/runtime/timer.h"
#include "common/wire/wire.h"

namespace footing::device_link {
namespace {

constexpr auto kRedial = std::chrono::milliseconds(250);
constexpr std::uint32_t kMaxEnvelopeBytes = 2048;

/// The command that starts a footingd which listens there: by default it does at the user's own.
std::string FootingdFor(const transport::Address& to) {
  const bool own = to.Text() == transport::DefaultAddress("devices").Text();
  return own ? "footingd" : "footingd --source stream:" + to.Text();
}

}  // namespace

class DeviceLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(boost::asio::io_context& io, Options options)
      : io_(io), options_(std::move(options)), redial_(io) {}

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

  bool Send(const v1::DeviceEnvelope& message) {
    const bool taken = connection_ && connection_->Send(message.SerializeAsString());
    ++(taken ? sent_ : dropped_);
    return taken;
  }

  void Stop(const std::string& reason) {
    stopped_ = true;
    redial_.cancel();
    if (connection_) connection_->Finish({}, reason);
  }

  bool open() const { return connection_ != nullptr; }
  bool was_open() const { return was_open_; }
  std::uint64_t sent() const { return sent_; }
  std::uint64_t dropped() const { return dropped_; }

 private:
  void Open(transport::Socket socket) {
    waits_for_.clear();
    was_open_ = true;
    transport::FramedLimits limits;
    limits.max_in_bytes = limits.max_out_bytes = kMaxEnvelopeBytes;
    limits.max_queued_frames = options_.max_queued_frames;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { OnFrame(payload); };
    handlers.on_close = [this](const std::string& reason) { OnClose(reason); };
    connection_ = std::make_unique<transport::FramedConnection>(std::move(socket), limits,
                                                                std::move(handlers));
    connection_->Start();
    if (options_.on_open) options_.on_open();
  }

  void OnFrame(std::string_view payload) {
    v1::DeviceEnvelope message;
    if (!message.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return;
    if (message.has_refused()) {
      log::Error("footingd: " + message.refused().reason());
      if (options_.on_refused) options_.on_refused(message.refused());
      return;
    }
    if (options_.on_message) options_.on_message(message);
  }

  void OnClose(const std::string& reason) {
    connection_.reset();
    if (stopped_) return;
    if (options_.on_close) options_.on_close();
    WaitFor(reason);
  }

  void WaitFor(const std::string& why) {
    if (why != waits_for_) {
      const std::string start = "start it with: " + FootingdFor(options_.to);
      log::Info("waiting for footingd: " + why + transport::RemedyFor(why, start));
    }
    waits_for_ = why;
    redial_.After(kRedial, [this] {
      const auto self = shared_from_this();  // A handler may let the link go.
      if (!stopped_) Dial();
    });
  }

  boost::asio::io_context& io_;
  const Options options_;
  timer::Timer redial_;
  std::unique_ptr<transport::FramedConnection> connection_;
  std::string waits_for_;
  std::uint64_t sent_ = 0, dropped_ = 0;
  bool stopped_ = false, was_open_ = false;
};

DeviceLink::DeviceLink(boost::asio::io_context& io, Options options)
    : implementation_(std::make_shared<Implementation>(io, std::move(options))) {}
DeviceLink::~DeviceLink() = default;

void DeviceLink::Start() { implementation_->Dial(); }
bool DeviceLink::Send(const v1::DeviceEnvelope& message) { return implementation_->Send(message); }
bool DeviceLink::Send(const stream::HandFrame& frame) {
  v1::DeviceEnvelope message;
  *message.mutable_hand_frame() = wire::ToProto(frame);
  return Send(message);
}
void DeviceLink::Stop(const std::string& reason) { implementation_->Stop(reason); }
bool DeviceLink::open() const { return implementation_->open(); }
bool DeviceLink::was_open() const { return implementation_->was_open(); }
std::uint64_t DeviceLink::sent() const { return implementation_->sent(); }
std::uint64_t DeviceLink::dropped() const { return implementation_->dropped(); }

Error NoFootingd(const transport::Address& to) {
  return NoDevice("no footingd listened for devices on " + to.Text() +
                  "; start it with: " + FootingdFor(to));
}

}  // namespace footing::device_link
