#include "common/net/identity.h"

#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/runtime/regular_file.h"
#include "common/runtime/write_file.h"
#include "common/net/fingerprint.h"

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
  char* text = nullptr;
  const long size = BIO_get_mem_data(memory.get(), &text);
  return {text, static_cast<std::size_t>(size)};
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

Identity::Identity(Key key, Certificate certificate)
    : key_(std::move(key)),
      certificate_(std::move(certificate)),
      fingerprint_(FingerprintOf(DerOf(certificate_.get()))) {}

Result<Identity> Identity::Load(const std::string& path) {
  const auto text = ReadPrivate(path);
  if (!text) return text.error();
  const auto open = [&] {
    return Memory(BIO_new_mem_buf(text->data(), static_cast<int>(text->size())), BIO_free);
  };
  const Memory of_key = open(), of_certificate = open();
  const auto no_password = [](char*, int, int, void*) { return -1; };
  Key key(PEM_read_bio_PrivateKey(of_key.get(), nullptr, no_password, nullptr), EVP_PKEY_free);
  Certificate certificate(PEM_read_bio_X509(of_certificate.get(), nullptr, no_password, nullptr),
                          X509_free);
  if (!key || !certificate || X509_check_private_key(certificate.get(), key.get()) != 1) {
    return InvalidData("identity " + path +
                       ": it must have a private key without a password and its certificate, both "
                       "as PEM; remove it to have a new one made, which every client must then "
                       "trust again");
  }
  return Identity(std::move(key), std::move(certificate));
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

}  // namespace footing::tls
