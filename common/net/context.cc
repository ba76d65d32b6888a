#include "common/net/context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <utility>

#include "common/net/fingerprint.h"

namespace footing::tls {
namespace {

/// Called in place of OpenSSL's check of the chain, before anything secret is sent.
int CheckCertificate(X509_STORE_CTX* store, void*) {
  const auto* const ssl = static_cast<const SSL*>(
      X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
  auto* const channel = ssl == nullptr ? nullptr : static_cast<Channel*>(SSL_get_app_data(ssl));
  X509* const certificate = X509_STORE_CTX_get0_cert(store);
  if (channel == nullptr || certificate == nullptr) return 0;
  unsigned char* bytes = nullptr;
  const int size = i2d_X509(certificate, &bytes);
  if (size <= 0) return 0;
  const std::string fingerprint =
      FingerprintOf({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size)});
  OPENSSL_free(bytes);
  if (channel->CheckPeer(fingerprint)) return 1;
  X509_STORE_CTX_set_error(store, X509_V_ERR_CERT_UNTRUSTED);
  return 0;
}

std::shared_ptr<SSL_CTX> NewContext(const SSL_METHOD* method) {
  constexpr long kLongestCertificate = 8 << 10;  // Ours have 400 bytes.
  std::shared_ptr<SSL_CTX> shared(SSL_CTX_new(method), SSL_CTX_free);
  if (!shared || SSL_CTX_set_min_proto_version(shared.get(), TLS1_3_VERSION) != 1) return nullptr;
  SSL_CTX_set_options(shared.get(), SSL_OP_NO_TICKET | SSL_OP_NO_RENEGOTIATION |
                                        SSL_OP_NO_COMPRESSION | SSL_OP_IGNORE_UNEXPECTED_EOF);
  SSL_CTX_set_num_tickets(shared.get(), 0);
  SSL_CTX_set_session_cache_mode(shared.get(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_max_cert_list(shared.get(), kLongestCertificate);
  SSL_CTX_set_read_ahead(shared.get(), 1);
  // An idle connection has no buffers; what waits to be written may have moved when it is tried
  // again.
  SSL_CTX_set_mode(shared.get(), SSL_MODE_RELEASE_BUFFERS | SSL_MODE_ENABLE_PARTIAL_WRITE |
                                     SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  SSL_CTX_set_cert_verify_callback(shared.get(), CheckCertificate, nullptr);
  return shared;
}

Error NoContext() {
  ERR_clear_error();
  return Failure("OpenSSL cannot do TLS 1.3 with this key");
}

}  // namespace

Result<Context> Context::ForServer(const Identity& identity) {
  const auto shared = NewContext(TLS_server_method());
  if (!shared || SSL_CTX_use_certificate(shared.get(), identity.certificate_.get()) != 1 ||
      SSL_CTX_use_PrivateKey(shared.get(), identity.key_.get()) != 1) {
    return NoContext();
  }
  SSL_CTX_set_verify(shared.get(), SSL_VERIFY_PEER, nullptr);
  return Context(shared);
}

Result<Context> Context::ForClient(const Identity* own) {
  const auto shared = NewContext(TLS_client_method());
  if (!shared) return NoContext();
  if (own != nullptr && (SSL_CTX_use_certificate(shared.get(), own->certificate_.get()) != 1 ||
                         SSL_CTX_use_PrivateKey(shared.get(), own->key_.get()) != 1)) {
    return NoContext();
  }
  SSL_CTX_set_verify(shared.get(), SSL_VERIFY_PEER, nullptr);
  return Context(shared);
}

std::unique_ptr<Channel> Context::Accept(int socket) const {
  return std::make_unique<Channel>(shared_, socket, true, nullptr);
}

std::unique_ptr<Channel> Context::Connect(int socket, CertificateCheck check) const {
  return std::make_unique<Channel>(shared_, socket, false, std::move(check));
}

}  // namespace footing::tls
