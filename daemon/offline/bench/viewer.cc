#include "daemon/offline/bench/viewer.h"

#include <utility>

#include "common/net/socket.h"
#include "footing/v1/session.pb.h"

namespace footing::bench {
namespace {

constexpr char kPingTag = (6 << 3) | 2;  // Envelope.ping, length-delimited.
constexpr std::uint32_t kViewerQueueTicks = 1024;

std::string HelloBytes() {
  v1::Envelope message;
  message.mutable_hello()->set_protocol_major(1);
  message.mutable_hello()->set_client_name("footing-bench");
  return message.SerializeAsString();
}

std::string SubscribeBytes() {
  v1::Envelope message;
  message.mutable_subscribe()->set_policy(v1::QUEUE_POLICY_DROP_OLDEST);
  message.mutable_subscribe()->set_queue_ticks(kViewerQueueTicks);
  return message.SerializeAsString();
}

}  // namespace

Viewer::Viewer(boost::asio::io_context& io, const transport::Address& address, Greeting greeting,
               bool reads, std::function<void(std::string_view)> on_frame)
    : on_frame_(std::move(on_frame)) {
  transport::Dial(io, address, [this, greeting, reads](Result<transport::Socket> socket) {
    if (!socket) return;  // It shows as not connected.
    transport::FramedLimits limits;
    limits.max_in_bytes = 1u << 20;
    transport::FramedHandlers handlers;
    handlers.on_frame = [this](std::string_view payload) { OnFrame(payload); };
    connection_.emplace(std::move(*socket), limits, std::move(handlers));
    if (greeting == Greeting::kSubscribe) {
      connection_->Send(HelloBytes());
      connection_->Send(SubscribeBytes());
    }
    if (reads) connection_->Start();
  });
}

void Viewer::OnFrame(std::string_view payload) {
  if (payload.empty() || payload[0] != kPingTag) {
    if (on_frame_) on_frame_(payload);
    return;
  }
  v1::Envelope ping;
  if (!ping.ParseFromArray(payload.data(), static_cast<int>(payload.size()))) return;
  v1::Envelope message;
  message.mutable_pong()->set_id(ping.ping().id());
  message.mutable_pong()->set_t0_ns(ping.ping().t0_ns());
  connection_->Send(message.SerializeAsString());
}

}  // namespace footing::bench
