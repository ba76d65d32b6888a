#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/net/tls_channel.h"

struct evp_pkey_st;  // OpenSSL's EVP_PKEY
struct x509_st;      // and X509

namespace footing::tls {

/// A private key (ECDSA P-256) with a self-signed certificate: who a server, or a client, is.
///
/// Footing's programs know it by its fingerprint alone, as with ssh: names, dates and chains mean
/// nothing, and a certificate that is made here never expires. Browsers look at all of them.
class Identity {
 public:
  /// From a PEM file of its owner alone (mode 0600 or less) with key and certificate, and those of
  /// the authorities above it, if any.
  static Result<Identity> Load(const std::string& path);

  /// The same; where there is no such file it is made, and the folders above it (mode 0700). Two
  /// programs that do so at once get the same one. The file belongs to whom its folder belongs to.
  static Result<Identity> LoadOrMake(const std::string& path, const std::string& common_name);

  const std::string& fingerprint() const { return fingerprint_; }

  /// Why browsers refuse it at this time (UNIX time, s) for an address or name of its host: "has
  /// expired on May  1 12:00:00 2026 GMT"; empty: for neither date nor name. One that names no
  /// host, as those that are made here, is for any.
  std::string FaultFor(const std::string& host, std::int64_t unix_s) const;
  /// The certificate without the key, as PEM.
  std::string CertificatePem() const;

 private:
  friend class Context;
  Identity(std::shared_ptr<evp_pkey_st> key, std::vector<std::shared_ptr<x509_st>> chain);

  std::shared_ptr<evp_pkey_st> key_;
  std::vector<std::shared_ptr<x509_st>> chain_;  ///< Its certificate, and the authorities' above.
  std::string fingerprint_;
};

}  // namespace footing::tls

struct ssl_ctx_st;  // OpenSSL's SSL_CTX

namespace footing::tls {

/// Looks at the fingerprint of the certificate that a server shows; says why it is refused, or
/// nothing.
using CertificateCheck = std::function<std::string(const std::string& fingerprint)>;

/// TLS settings that all connections of a server, or of a client, share. TLS 1.3 and nothing older;
/// no tickets, no resumption, no early data.
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

// The SHA-256 of a certificate (of its DER bytes), by which people and programs know it again.

/// "sha256:" and 64 hexadecimal digits in lower case.
std::string FingerprintOf(std::string_view der);

/// The same form from what people write: the prefix may be missing, colons may stand between the
/// bytes (as `openssl x509 -fingerprint -sha256` prints them), and the case does not matter. None
/// when it is not a SHA-256.
std::optional<std::string> ParseFingerprint(std::string_view text);

}  // namespace footing::tls
