#include "daemon/offline/bench/broker_link.h"

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <charconv>
#include <utility>

namespace footing::bench {
namespace {

constexpr std::string_view kTopic = "t";
// Control packets of MQTT 3.1.1, sections 3.1 to 3.9.
constexpr char kConnect = 0x10, kPublish = 0x30;
constexpr auto kSubscribe = static_cast<char>(0x82);
constexpr unsigned char kConnectAnswer = 0x20, kSubscribeAnswer = 0x90;

std::string Text(std::string_view text) {
  std::string bytes = {static_cast<char>(text.size() >> 8), static_cast<char>(text.size())};
  return bytes.append(text);
}

std::string Packet(char kind, std::string_view body) {
  std::string bytes(1, kind);
  for (std::size_t left = body.size();; left /= 128) {
    bytes += static_cast<char>(left % 128 | (left >= 128 ? 0x80 : 0));
    if (left < 128) break;
  }
  return bytes.append(body);
}

std::string Greeting(BrokerKind kind, BrokerLink::Part part, int number) {
  const bool subscribes = part == BrokerLink::Part::kSubscribes;
  if (kind == BrokerKind::kNats) {
    return "CONNECT {\"verbose\":false,\"pedantic\":false}\r\n" +
           std::string(subscribes ? "SUB t 1\r\n" : "") + "PING\r\n";
  }
  const std::string options("\x04\x02\x00\x00", 4);  // 3.1.1, a clean session, no keep-alive.
  std::string bytes = Packet(kConnect, Text("MQTT") + options + Text("b" + std::to_string(number)));
  if (subscribes) bytes += Packet(kSubscribe, std::string("\0\1", 2) + Text(kTopic) + '\0');
  return bytes;
}

/// What stands at the front of the bytes.
struct Front {
  std::size_t size = 0;  ///< 0: more must come.
  std::optional<std::string_view> payload;
  bool ready = false;
};

Front LookAtNats(std::string_view bytes) {
  const std::size_t end = bytes.find("\r\n");
  if (end == std::string_view::npos) return {};
  const std::string_view line = bytes.substr(0, end);
  if (line.starts_with("PONG")) return {end + 2, {}, true};
  if (!line.starts_with("MSG ")) return {end + 2, {}, false};
  std::size_t size = 0;
  const std::size_t number = line.rfind(' ') + 1;
  std::from_chars(line.data() + number, line.data() + line.size(), size);
  if (bytes.size() < end + 2 + size + 2) return {};
  return {end + 2 + size + 2, bytes.substr(end + 2, size), false};
}

Front LookAtMqtt(std::string_view bytes, BrokerLink::Part part) {
  std::size_t size = 0, at = 1;
  for (int shift = 0;; shift += 7) {
    if (at >= bytes.size()) return {};
    const auto byte = static_cast<unsigned char>(bytes[at++]);
    size |= std::size_t{byte & 0x7fu} << shift;
    if (byte < 0x80) break;
  }
  if (bytes.size() < at + size) return {};
  const auto kind = static_cast<unsigned char>(bytes[0]);
  const bool subscribes = part == BrokerLink::Part::kSubscribes;
  if ((kind & 0xf0) != kPublish) {
    return {at + size, {}, kind == (subscribes ? kSubscribeAnswer : kConnectAnswer)};
  }
  const std::size_t topic = 2 + kTopic.size();
  return {at + size, bytes.substr(at + topic, size - topic), false};
}

}  // namespace

class BrokerLink::Implementation : public std::enable_shared_from_this<Implementation> {
 public:
  Implementation(BrokerKind kind, Part part, std::function<void(std::string_view)> on_payload)
      : kind_(kind), part_(part), on_payload_(std::move(on_payload)) {}

  void Dial(boost::asio::io_context& io, const Broker& broker, int number) {
    transport::Dial(io, broker.address(),
                    [self = shared_from_this(), number](Result<transport::Socket> socket) {
                      if (!socket) return;  // It shows as not ready.
                      self->socket_.emplace(std::move(*socket));
                      transport::Prepare(*self->socket_);
                      self->Send(Greeting(self->kind_, self->part_, number));
                      self->Read();
                    });
  }

  void Publish(std::string_view payload) {
    if (kind_ == BrokerKind::kMosquitto) {
      return Send(Packet(kPublish, Text(kTopic).append(payload)));
    }
    std::string bytes = "PUB t " + std::to_string(payload.size()) + "\r\n";
    Send(bytes.append(payload).append("\r\n"));
  }

  void Close() {
    if (socket_) socket_->Close();
  }

  bool ready() const { return ready_; }

 private:
  void Send(std::string_view bytes) {
    if (!socket_) return;
    queued_.append(bytes);
    if (writing_.empty()) Write();
  }

  void Write() {
    writing_ = std::exchange(queued_, {});
    if (writing_.empty()) return;
    boost::asio::async_write(
        socket_->plain(), boost::asio::buffer(writing_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
          self->writing_.clear();
          if (!error) self->Write();
        });
  }

  void Read() {
    socket_->plain().async_read_some(
        boost::asio::buffer(in_),
        [self = shared_from_this()](const boost::system::error_code& error, std::size_t count) {
          if (error) return;
          self->Take({self->in_.data(), count});
          self->Read();
        });
  }

  void Take(std::string_view bytes) {
    if (!rest_.empty()) {
      rest_.append(bytes);
      bytes = rest_;
    }
    while (bytes.size() > 1) {
      const Front front = kind_ == BrokerKind::kNats ? LookAtNats(bytes) : LookAtMqtt(bytes, part_);
      if (front.size == 0) break;
      if (front.ready) ready_ = true;
      if (front.payload && on_payload_) on_payload_(*front.payload);
      bytes.remove_prefix(front.size);
    }
    rest_ = std::string(bytes);
  }

  BrokerKind kind_;
  Part part_;
  std::function<void(std::string_view)> on_payload_;
  std::optional<transport::Socket> socket_;
  std::array<char, 16 << 10> in_;
  std::string rest_, queued_, writing_;
  bool ready_ = false;
};

BrokerLink::BrokerLink(boost::asio::io_context& io, const Broker& broker, Part part, int number,
                       std::function<void(std::string_view)> on_payload)
    : implementation_(
          std::make_shared<Implementation>(broker.kind(), part, std::move(on_payload))) {
  implementation_->Dial(io, broker, number);
}
BrokerLink::~BrokerLink() { implementation_->Close(); }

bool BrokerLink::ready() const { return implementation_->ready(); }
void BrokerLink::Publish(std::string_view payload) { implementation_->Publish(payload); }

}  // namespace footing::bench
