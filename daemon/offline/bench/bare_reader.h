#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>

#include "common/net/socket.h"

namespace footing::bench {

/// A frame with a payload of so many bytes, the first eight of which are the instant now.
std::shared_ptr<const std::string> StampedFrame(std::size_t payload_bytes);

/// The instant in the payload of a StampedFrame.
std::int64_t StampOf(std::string_view payload);

/// Bare Asio's reading side: frames of one known length, one async_read each.
class BareReader {
 public:
  BareReader(boost::asio::io_context& io, const transport::Address& address,
             std::size_t frame_bytes, std::function<void(std::string_view)> on_payload);

  bool connected() const { return socket_.has_value(); }

 private:
  void Read();

  std::string frame_;
  std::function<void(std::string_view)> on_payload_;
  std::optional<transport::Socket> socket_;
};

}  // namespace footing::bench
