#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"

struct evp_pkey_st;  // OpenSSL's EVP_PKEY
struct x509_st;      // and X509

namespace footing::tls {

/// A private key (ECDSA P-256) with a self-signed certificate: who a server, or a client, is.
///
/// Others know it by its fingerprint alone, as with ssh: names, dates and chains mean nothing, and
/// the certificate never expires.
class Identity {
 public:
  /// From a PEM file of its owner alone (mode 0600 or less) with key and certificate.
  static Result<Identity> Load(const std::string& path);

  /// The same; where there is no such file it is made, and the folders above it (mode 0700). Two
  /// programs that do so at once get the same one. The file belongs to whom its folder belongs to.
  static Result<Identity> LoadOrMake(const std::string& path, const std::string& common_name);

  const std::string& fingerprint() const { return fingerprint_; }

 private:
  friend class Context;
  Identity(std::shared_ptr<evp_pkey_st> key, std::shared_ptr<x509_st> certificate);

  std::shared_ptr<evp_pkey_st> key_;
  std::shared_ptr<x509_st> certificate_;
  std::string fingerprint_;
};

}  // namespace footing::tls
