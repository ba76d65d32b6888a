#include "common/net/tls_context.h"

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

#include <openssl/ec.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/sha.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/text.h"
#include "common/runtime/files.h"

namespace footing::tls {
namespace {

using Key = std::shared_ptr<EVP_PKEY>;
using Certificate = std::shared_ptr<X509>;
using Memory = std::unique_ptr<BIO, decltype(&BIO_free)>;

constexpr std::size_t kLongestFile = 64u << 10;

Error FileError(const std::string& path, const std::string& what) {
  return Failure("identity " + path + ": " + what);
}

std::string DerOf(X509* certificate) {
  unsigned char* bytes = nullptr;
  const int size = i2d_X509(certificate, &bytes);
  if (size <= 0) return "";
  std::string der(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  OPENSSL_free(bytes);
  return der;
}

Certificate MakeCertificate(EVP_PKEY* key, const std::string& common_name) {
  Certificate made(X509_new(), X509_free);
  std::uint64_t serial = 0;
  bool ok = made && RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof(serial)) == 1;
  constexpr std::uint64_t kPositive = ~0ull >> 1;
  ok = ok && X509_set_version(made.get(), X509_VERSION_3) == 1;
  ok = ok && ASN1_INTEGER_set_uint64(X509_get_serialNumber(made.get()), serial & kPositive) == 1;
  // Nobody looks at the dates: RFC 5280, 4.1.2.5, has this one for "never".
  ok = ok && ASN1_TIME_set_string_X509(X509_getm_notBefore(made.get()), "20000101000000Z") == 1;
  ok = ok && ASN1_TIME_set_string_X509(X509_getm_notAfter(made.get()), "99991231235959Z") == 1;
  X509_NAME* const name = made ? X509_get_subject_name(made.get()) : nullptr;
  ok = ok && X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_UTF8,
                                        reinterpret_cast<const unsigned char*>(common_name.c_str()),
                                        -1, -1, 0) == 1;
  ok = ok && X509_set_issuer_name(made.get(), name) == 1;
  ok = ok && X509_set_pubkey(made.get(), key) == 1;
  ok = ok && X509_sign(made.get(), key, EVP_sha256()) > 0;
  return ok ? made : nullptr;
}

std::string TextOf(const Memory& memory) {
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

/// Key and certificate as PEM text; empty when OpenSSL cannot.
std::string MakePem(const std::string& common_name) {
  const Key key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  const Certificate certificate = key ? MakeCertificate(key.get(), common_name) : nullptr;
  const Memory memory(BIO_new(BIO_s_mem()), BIO_free);
  if (!certificate || !memory) return "";
  if (PEM_write_bio_PKCS8PrivateKey(memory.get(), key.get(), nullptr, nullptr, 0, nullptr,
                                    nullptr) != 1 ||
      PEM_write_bio_X509(memory.get(), certificate.get()) != 1) {
    return "";
  }
  return TextOf(memory);
}

/// Writes beside, then links: the file is complete as soon as it is there, and the first one stays.
Result<void> WriteOnce(const std::string& path, const std::string& text) {
  if (const auto made = config::MakeFoldersAbove(path); !made) {
    return FileError(path, made.error().message);
  }
  std::string beside = path + ".XXXXXX";
  const int file = mkstemp(beside.data());  // Mode 0600.
  if (file < 0) return FileError(path, std::string("cannot be made: ") + std::strerror(errno));
  struct stat folder {};
  const std::string parent = path.substr(0, path.rfind('/') + 1);
  if (geteuid() == 0 && stat(parent.empty() ? "." : parent.c_str(), &folder) == 0) {
    [[maybe_unused]] const int owned = fchown(file, folder.st_uid, folder.st_gid);
  }
  const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       fsync(file) == 0;
  const std::string why = std::strerror(errno);
  close(file);
  const bool linked = written && (link(beside.c_str(), path.c_str()) == 0 || errno == EEXIST);
  const std::string why_not = written ? std::strerror(errno) : why;
  unlink(beside.c_str());
  return linked ? Result<void>() : FileError(path, "cannot be written: " + why_not);
}

Result<std::string> ReadPrivate(const std::string& path) {
  const auto file = config::RegularFile::Open(path);
  if (!file) return FileError(path, file.error().message);
  if (file->Allows(S_IRWXG | S_IRWXO)) {
    return UsageError("identity " + path + " may be read by others; chmod 600 " + path);
  }
  auto text = file->Read(kLongestFile);
  if (!text) return FileError(path, text.error().message);
  return text;
}

}  // namespace

Identity::Identity(Key key, std::vector<Certificate> chain)
    : key_(std::move(key)),
      chain_(std::move(chain)),
      fingerprint_(FingerprintOf(DerOf(chain_.front().get()))) {}

Result<Identity> Identity::Load(const std::string& path) {
  const auto text = ReadPrivate(path);
  if (!text) return text.error();
  const auto open = [&] {
    return Memory(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())), BIO_free);
  };
  const Memory of_key = open(), of_certificate = open();
  const auto no_password = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_bio_PrivateKey(of_key.get(), nullptr, no_password, nullptr), EVP_PKEY_free);
  std::vector<Certificate> chain;
  while (X509* const one = PEM_read_bio_X509(of_certificate.get(), nullptr, no_password, nullptr)) {
    chain.emplace_back(one, X509_free);
  }
  ERR_clear_error();
  if (!key || chain.empty() || X509_check_private_key(chain.front().get(), key.get()) != 1) {
    return InvalidData("identity " + path +
                       ": it must have a private key without a password and its certificate, both "
                       "as PEM; remove it to have a new one made, which every client must then "
                       "trust again");
  }
  return Identity(std::move(key), std::move(chain));
}

Result<Identity> Identity::LoadOrMake(const std::string& path, const std::string& common_name) {
  if (path.empty()) return Failure("identity: there is no home folder for it; name a file");
  if (access(path.c_str(), F_OK) != 0 && errno == ENOENT) {
    const std::string pem = MakePem(common_name);
    if (pem.empty()) return FileError(path, "OpenSSL cannot make a key");
    if (auto written = WriteOnce(path, pem); !written) return written.error();
  }
  return Load(path);
}

namespace {

std::string DateText(const ASN1_TIME* time) {
  const Memory memory(BIO_new(BIO_s_mem()), BIO_free);
  return ASN1_TIME_print(memory.get(), time) == 1 ? TextOf(memory) : "an unknown date";
}

}  // namespace

std::string Identity::FaultFor(const std::string& host, std::int64_t unix_s) const {
  X509* const own = chain_.front().get();
  time_t now = unix_s;
  if (X509_cmp_time(X509_get0_notAfter(own), &now) < 0) {
    return "has expired on " + DateText(X509_get0_notAfter(own));
  }
  if (X509_cmp_time(X509_get0_notBefore(own), &now) > 0) {
    return "is not valid before " + DateText(X509_get0_notBefore(own));
  }
  if (X509_get_ext_by_NID(own, NID_subject_alt_name, -1) < 0 ||
      X509_check_ip_asc(own, host.c_str(), 0) == 1 ||
      X509_check_host(own, host.c_str(), host.size(), X509_CHECK_FLAG_NEVER_CHECK_SUBJECT,
                      nullptr) == 1) {
    return "";
  }
  return "is not for " + host;
}

std::string Identity::CertificatePem() const {
  const Memory memory(BIO_new(BIO_s_mem()), BIO_free);
  return PEM_write_bio_X509(memory.get(), chain_.front().get()) == 1 ? TextOf(memory) : "";
}

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
  if (!shared || SSL_CTX_use_certificate(shared.get(), identity.chain_.front().get()) != 1 ||
      SSL_CTX_use_PrivateKey(shared.get(), identity.key_.get()) != 1) {
    return NoContext();
  }
  for (std::size_t i = 1; i < identity.chain_.size(); ++i) {
    if (SSL_CTX_add1_chain_cert(shared.get(), identity.chain_[i].get()) != 1) return NoContext();
  }
  SSL_CTX_set_verify(shared.get(), SSL_VERIFY_PEER, nullptr);
  return Context(shared);
}

Result<Context> Context::ForClient(const Identity* own) {
  const auto shared = NewContext(TLS_client_method());
  if (!shared) return NoContext();
  if (own != nullptr && (SSL_CTX_use_certificate(shared.get(), own->chain_.front().get()) != 1 ||
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

namespace {

constexpr std::string_view kPrefix = "sha256:";

}  // namespace

std::string FingerprintOf(std::string_view der) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest;
  SHA256(reinterpret_cast<const unsigned char*>(der.data()), der.size(), digest.data());
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text(kPrefix);
  for (const unsigned byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 0xfu];
  }
  return text;
}

std::optional<std::string> ParseFingerprint(std::string_view text) {
  std::string lower = text::Lower(std::string(text));
  if (lower.starts_with(kPrefix)) lower.erase(0, kPrefix.size());
  std::string digits;
  for (const char c : lower) {
    if (c == ':') continue;
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0) return std::nullopt;
    digits += c;
  }
  if (digits.size() != 2 * SHA256_DIGEST_LENGTH) return std::nullopt;
  return std::string(kPrefix) + digits;
}

}  // namespace footing::tls
