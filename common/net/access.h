#pragma once

#include <boost/asio/io_context.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/runtime/config.h"
#include "common/base/result.h"
#include "common/runtime/timer.h"
#include "common/net/server.h"
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

}  // namespace footing::transport
