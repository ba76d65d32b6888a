#pragma once

#include <string>

#include "common/base/result.h"
#include "common/net/address.h"

/// What a server needs before it listens where others than this host's users reach it.
namespace footing::transport {

/// What an administrator gives, by the names that the program has for it.
struct ListenSettings {
  std::string keys = "set token_file or clients_file";
  std::string in_clear = "--set insecure_lan=true with a token_file";
};

/// Of an address that speaks TLS: usage error when nobody has a key, neither a token nor a
/// certificate.
Result<void> CheckKeys(const Address& address, bool has_keys, const ListenSettings& settings = {});

/// Usage error for tcp: beyond this host, unless `in_clear` permits it.
Result<void> CheckEncrypted(const Address& address, bool in_clear,
                            const ListenSettings& settings = {});

}  // namespace footing::transport
