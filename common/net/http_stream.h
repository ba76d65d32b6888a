#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/role.hpp>

#include "common/net/socket.h"

namespace footing::http_server {

/// A connection as the streams of Boost.Beast want it, in clear or within TLS: one type, since each
/// further type doubles what the compiler has to do. The handshake of TLS is done before.
class Stream {
 public:
  using executor_type = transport::Socket::executor_type;
  using error_code = transport::Socket::error_code;

  explicit Stream(transport::Socket socket)
      : socket_(std::make_unique<transport::Socket>(std::move(socket))) {}

  executor_type get_executor() { return socket_->get_executor(); }
  transport::Socket& socket() { return *socket_; }

  template <typename Buffers, typename Handler>
  void async_read_some(const Buffers& buffers, Handler&& handler) {
    boost::asio::mutable_buffer into;
    for (auto i = boost::asio::buffer_sequence_begin(buffers);
         into.size() == 0 && i != boost::asio::buffer_sequence_end(buffers); ++i) {
      into = *i;
    }
    socket_->AsyncReadSome(into, std::forward<Handler>(handler));
  }

  template <typename Buffers, typename Handler>
  void async_write_some(const Buffers& buffers, Handler&& handler) {
    Parts parts;
    for (auto i = boost::asio::buffer_sequence_begin(buffers);
         parts.count < parts.buffers.size() && i != boost::asio::buffer_sequence_end(buffers);
         ++i) {
      const boost::asio::const_buffer part(*i);
      if (part.size() > 0) parts.buffers[parts.count++] = part;
    }
    Write(*socket_, parts, std::forward<Handler>(handler));
  }

 private:
  /// As many buffers as one call of the kernel takes of them.
  struct Parts {
    std::array<boost::asio::const_buffer, 16> buffers{};
    std::size_t count = 0;
  };

  template <typename Handler>
  static void Write(transport::Socket& socket, const Parts& parts, Handler&& handler) {
    error_code error;
    const std::size_t written =
        parts.count == 0 ? 0
                         : socket.WriteSome(std::span(parts.buffers.data(), parts.count), error);
    if (error != boost::asio::error::would_block) {
      boost::asio::post(socket.get_executor(), [handler = std::forward<Handler>(handler), error,
                                                written]() mutable { handler(error, written); });
      return;
    }
    socket.AsyncWait(tls::Progress::kWantsWrite,
                     [&socket, parts,
                      handler = std::forward<Handler>(handler)](const error_code& failed) mutable {
                       if (failed) return handler(failed, 0);
                       Write(socket, parts, std::move(handler));
                     });
  }

  std::unique_ptr<transport::Socket> socket_;
};

// How Beast ends such a connection.

inline void beast_close_socket(Stream& stream) { stream.socket().Close(); }

inline void teardown(boost::beast::role_type, Stream& stream, Stream::error_code& error) {
  error = {};
  stream.socket().SayNoMore();
}

template <typename Handler>
void async_teardown(boost::beast::role_type, Stream& stream, Handler&& handler) {
  stream.socket().SayNoMore();
  boost::asio::post(stream.get_executor(), [handler = std::forward<Handler>(handler)]() mutable {
    handler(Stream::error_code());
  });
}

}  // namespace footing::http_server
