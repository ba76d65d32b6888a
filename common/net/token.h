#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/result.h"
#include "common/net/token_bucket.h"
#include "footing/v1/session.pb.h"

/// Secrets by which clients over TCP and TLS get the role control, or only view. They are never
/// logged.
namespace footing::transport {

/// The first line of a file that only its owner may read (mode 0600 or less): 16 to 256 printable
/// characters without blanks.
Result<std::string> ReadTokenFile(const std::string& path);

/// Of the file that FOOTING_TOKEN_FILE names; empty when it names none. An error names the
/// variable, the file and what is wrong with it.
Result<std::string> TokenFromEnvironment();

/// Whether both are equal, in a time that does not depend on where they differ.
bool IsSameSecret(std::string_view a, std::string_view b);

/// The server's tokens. A right one is right at any time, however many wrong ones came from its
/// host: who shares an address with somebody that guesses is not kept out. Guessing stays slow
/// since wrong ones wait for their answer, all but the first five of a host and one more in 5 s.
class TokenGuard {
 public:
  struct Verdict {
    v1::Role role = v1::ROLE_UNSPECIFIED;  ///< That the token gives; unspecified: it is wrong.
    bool waits = false;                    ///< A wrong one: answer it later.
  };

  /// Gives control, or only view; an empty one is never right.
  explicit TokenGuard(std::string token = "", std::string view_token = "")
      : token_(std::move(token)), view_token_(std::move(view_token)) {}

  /// Neither the result nor the time that it takes says in what a wrong token differs.
  Verdict Check(std::string_view presented, const std::string& host, std::int64_t now_ns);

 private:
  TokenBucket& TriesOf(const std::string& host, std::int64_t now_ns);

  std::string token_;
  std::string view_token_;
  std::map<std::string, TokenBucket> tries_;  ///< Of hosts that were wrong lately.
};

}  // namespace footing::transport
