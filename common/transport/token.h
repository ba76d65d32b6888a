#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "common/result/result.h"
#include "common/transport/token_bucket.h"

/// A secret by which a client over TCP gets the role control. It is never logged.
namespace footing::transport {

/// The first line of a file that only its owner may read (mode 0600 or less): 16 to 256 printable
/// characters without blanks.
Result<std::string> ReadTokenFile(const std::string& path);

/// Of the file that FOOTING_TOKEN_FILE names; empty when it names none. An error names the
/// variable, the file and what is wrong with it.
Result<std::string> TokenFromEnvironment();

/// Whether both are equal, in a time that does not depend on where they differ.
bool IsSameSecret(std::string_view a, std::string_view b);

/// The server's token. After 5 wrong ones of a host every further one of it waits: one in 5 s is
/// looked at. Others are not kept out by it, unless hundreds of hosts guess at once.
class TokenGuard {
 public:
  /// Empty: no token is right.
  explicit TokenGuard(std::string token = "") : token_(std::move(token)) {}

  bool Accepts(std::string_view presented, const std::string& host, std::int64_t now_ns);

 private:
  TokenBucket& TriesOf(const std::string& host, std::int64_t now_ns);

  std::string token_;
  std::map<std::string, TokenBucket> tries_;  ///< Of hosts that were wrong lately.
};

}  // namespace footing::transport
