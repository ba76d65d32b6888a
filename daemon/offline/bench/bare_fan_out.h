#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/net/listener.h"

namespace footing::bench {

/// The baseline: what a fan-out of bytes costs with Asio and nothing else. One thread, one shared
/// buffer a frame, one async_write a session, TCP_NODELAY; no queue, no handshake.
class BareFanOut {
 public:
  explicit BareFanOut(boost::asio::io_context& io) : io_(io) {}

  Result<void> Listen(const transport::Address& address);
  const transport::Address& address() const { return listener_->address(); }

  void Publish(const std::shared_ptr<const std::string>& frame);
  std::size_t sessions() const { return sockets_.size(); }

 private:
  boost::asio::io_context& io_;
  std::unique_ptr<transport::Listener> listener_;
  std::vector<std::shared_ptr<transport::Socket>> sockets_;
};

}  // namespace footing::bench
