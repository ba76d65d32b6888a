#include "daemon/offline/bench/bare_reader.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/read.hpp>
#include <cstring>
#include <utility>

#include "common/runtime/clock.h"
#include "common/net/framing.h"

namespace footing::bench {

std::shared_ptr<const std::string> StampedFrame(std::size_t payload_bytes) {
  std::string payload(payload_bytes, '\0');
  const std::int64_t now_ns = clock::MonotonicNs();
  std::memcpy(payload.data(), &now_ns, sizeof(now_ns));
  return std::make_shared<const std::string>(transport::Frame(payload));
}

std::int64_t StampOf(std::string_view payload) {
  std::int64_t stamp_ns = 0;
  std::memcpy(&stamp_ns, payload.data(), sizeof(stamp_ns));
  return stamp_ns;
}

BareReader::BareReader(boost::asio::io_context& io, const transport::Address& address,
                       std::size_t frame_bytes, std::function<void(std::string_view)> on_payload)
    : frame_(frame_bytes, '\0'), on_payload_(std::move(on_payload)) {
  transport::Dial(io, address, [this](Result<transport::Socket> socket) {
    if (!socket) return;  // It shows as not connected.
    socket_.emplace(std::move(*socket));
    Read();
  });
}

void BareReader::Read() {
  boost::asio::async_read(socket_->plain(), boost::asio::buffer(frame_),
                          [this](const boost::system::error_code& error, std::size_t) {
                            if (error) return;
                            on_payload_(std::string_view(frame_).substr(transport::kLengthBytes));
                            Read();
                          });
}

}  // namespace footing::bench
