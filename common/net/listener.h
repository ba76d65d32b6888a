#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "common/base/result.h"
#include "common/net/address.h"
#include "common/net/socket.h"
#include "common/net/tls_context.h"

namespace footing::transport {

/// Permissions of a listener beyond this host.
struct ListenSecurity {
  /// Asked when it is to listen on tls:, or on a socket of TCP that was passed. Empty: it never
  /// does.
  std::function<Result<tls::Context>()> tls;
  bool insecure_lan = false;  ///< Listen on tcp: beyond loopback, not encrypted.
  /// A socket of TCP that was passed speaks in clear, and is refused beyond loopback.
  bool passed_in_clear = false;
};

/// Accepts connections on one address and hands over their sockets.
///
/// Unix: mode 0660. A socket file left over by a dead server is replaced; one with a living server
/// behind it is never touched. The own file is removed at the end. TCP beyond loopback is refused
/// unless `insecure_lan` is set. On tls: the sockets' handshakes are still to come.
class Listener {
 public:
  /// Begins to listen. Errors say which address, why, and what to do.
  static Result<std::unique_ptr<Listener>> Open(boost::asio::io_context& io, const Address& address,
                                                std::function<void(Socket)> on_accept,
                                                const ListenSecurity& security = {});
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// The bound address: with the real port where 0 was asked for.
  const Address& address() const;

  /// No further connection is accepted; the Unix socket's file goes away. May be called twice.
  void Close();

 private:
  class Implementation;
  explicit Listener(std::shared_ptr<Implementation> implementation);
  std::shared_ptr<Implementation> implementation_;
};

}  // namespace footing::transport
