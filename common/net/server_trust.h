#pragma once

#include <boost/asio/io_context.hpp>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/context.h"
#include "common/net/known_servers.h"
#include "common/net/address.h"

namespace footing::transport {

/// Which certificate a client takes from a tls: server. The first one that it sees is remembered in
/// the user's file of known servers, and logged; another one later is refused, since nobody can say
/// whether the server made a new one or somebody else answers in its place.
class ServerTrust {
 public:
  static std::shared_ptr<ServerTrust> Of(const Address& address);

  ServerTrust(std::string server, tls::KnownServers known)
      : server_(std::move(server)), known_(std::move(known)) {}

  /// Why the certificate is refused; empty when it is not.
  std::string WhyRefused(const std::string& fingerprint);
  /// The server has proved that the certificate is its own: a new one is remembered. Why it is
  /// refused all the same; empty when it is not.
  std::string OnProved(const std::string& fingerprint);

 private:
  std::string server_;
  tls::KnownServers known_;
  bool is_new_ = false;
};

/// The name of a server in the file of known servers: "HOST:PORT".
std::string KnownName(const Address& address);

/// What clients connect with: the user's own certificate where there is one, which
/// `footing-ctl trust --client` makes (see tls::ClientIdentityFile). Made once for all of a loop,
/// since that takes as long as a handshake's computations.
Result<tls::Context> ClientContext(boost::asio::io_context& io);

}  // namespace footing::transport
