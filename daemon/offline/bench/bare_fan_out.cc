#include "daemon/offline/bench/bare_fan_out.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/write.hpp>

namespace footing::bench {

Result<void> BareFanOut::Listen(const transport::Address& address) {
  auto listener = transport::Listener::Open(io_, address, [this](transport::Socket socket) {
    boost::system::error_code ignored;  // A Unix socket has no such option.
    socket.plain().set_option(boost::asio::ip::tcp::no_delay(true), ignored);
    sockets_.push_back(std::make_shared<transport::Socket>(std::move(socket)));
  });
  if (!listener) return listener.error();
  listener_ = std::move(*listener);
  return {};
}

void BareFanOut::Publish(const std::shared_ptr<const std::string>& frame) {
  for (const auto& socket : sockets_) {
    boost::asio::async_write(socket->plain(), boost::asio::buffer(*frame),
                             [socket, frame](const boost::system::error_code&, std::size_t) {});
  }
}

}  // namespace footing::bench
