#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <boost/asio/io_context.hpp>

#include "common/base/result.h"
#include "common/net/limits.h"
#include "common/net/server.h"
#include "common/runtime/config.h"
#include "common/runtime/timer.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Who may come over TCP and TLS: settings of both servers.
struct AccessSettings {
  std::string token_file;       ///< Whose token gives the role control over TCP and TLS.
  std::string view_token_file;  ///< Whose token gives the role view.
  std::string clients_file;     ///< Whose certificates give their roles over TLS.
  std::string identity_file;    ///< The server's own; empty: tls::DefaultIdentityFile().
  bool insecure_lan = false;
  std::string advertise;  ///< Name in the network, by mDNS; empty: not advertised.

  void Bind(config::Binder& binder);
  /// Usage error for settings that do not go together.
  Result<void> Check() const;
  /// Whether a server with these settings may listen on these addresses: reads the files as Apply
  /// does, and the certificate where there is one, but opens no socket and makes no file.
  Result<void> CheckStart(const std::vector<std::string>& listen) const;
  /// Reads the files into the options; an error names the file, and the line.
  Result<void> Apply(ServerOptions& options) const;
  /// Reads the token files and clients_file again. What came in by a token or a certificate that is
  /// gone is ended, and the log says how many sessions. Returns the settings ("token_file") whose
  /// files have another content. An error changes nothing.
  Result<std::vector<std::string>> Reapply(Server& server) const;
};

/// Logs now and every hour that insecure_lan is on, until the timer that it returns is gone.
[[nodiscard]] std::shared_ptr<timer::Timer> WarnOfInsecureLan(boost::asio::io_context& io);

/// The certificates that a server lets in: lines "sha256:... ROLE" with the role view, log or
/// control; more words, such as whose it is, and what begins with # are comments.
Result<std::map<std::string, v1::Role>> ParseClients(const std::string& text);

// Secrets by which clients over TCP and TLS get the role control, or only view. They are never
// logged.

/// The first line of a file that only its owner may read (mode 0600 or less): 16 to 256 printable
/// characters without blanks.
Result<std::string> ReadTokenFile(const std::string& path);

/// Token of the file that FOOTING_TOKEN_FILE names; empty when it names none. An error names the
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
  std::map<std::string, TokenBucket> tries_;  ///< Buckets of hosts that were wrong lately.
};

}  // namespace footing::transport
