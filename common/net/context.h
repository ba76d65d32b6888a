#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/base/result.h"
#include "common/net/channel.h"
#include "common/net/identity.h"

struct ssl_ctx_st;  // OpenSSL's SSL_CTX

namespace footing::tls {

/// Looks at the fingerprint of the certificate that a server shows; says why it is refused, or
/// nothing.
using CertificateCheck = std::function<std::string(const std::string& fingerprint)>;

/// What all TLS connections of a server, or of a client, share. TLS 1.3 and nothing older; no
/// tickets, no resumption, no early data.
class Context {
 public:
  /// Clients may show a certificate. Whether it is a known one the session decides.
  static Result<Context> ForServer(const Identity& identity);
  /// `own` is shown to a server that asks for a certificate; may be null.
  static Result<Context> ForClient(const Identity* own);

  /// The server's end of a connection on this socket, which outlives it.
  std::unique_ptr<Channel> Accept(int socket) const;
  /// The client's end; `check` is asked before anything is sent that is not for everybody.
  std::unique_ptr<Channel> Connect(int socket, CertificateCheck check) const;

 private:
  explicit Context(std::shared_ptr<ssl_ctx_st> shared) : shared_(std::move(shared)) {}

  std::shared_ptr<ssl_ctx_st> shared_;
};

}  // namespace footing::tls
