#pragma once

#include <map>
#include <string>

#include "common/config/config.h"
#include "common/result/result.h"
#include "common/transport/server.h"
#include "footing/v1/session.pb.h"

namespace footing::transport {

/// Who may come over TCP and TLS: settings of both servers.
struct AccessSettings {
  std::string token_file;     ///< Whose token gives the role control over TCP and TLS.
  std::string clients_file;   ///< Whose certificates give their roles over TLS.
  std::string identity_file;  ///< The server's own; empty: tls::DefaultIdentityFile().
  bool insecure_lan = false;
  std::string advertise;  ///< Name in the network, by mDNS; empty: not advertised.

  void Bind(config::Binder& binder);
  /// Usage error for settings that do not go together.
  Result<void> Check() const;
  /// Reads the files into the options; an error names the file, and the line.
  Result<void> Apply(ServerOptions& options) const;
};

/// The certificates that a server lets in: lines "sha256:... ROLE NAME" with the role view, log or
/// control; what begins with # is a comment.
Result<std::map<std::string, v1::Role>> ParseClients(const std::string& text);

}  // namespace footing::transport
