#pragma once

#include <optional>
#include <string>

#include "common/base/result.h"

namespace footing::tls {

/// The servers that a user trusts, by their certificates' fingerprints: a text file with a line
/// "HOST:PORT sha256:..." each; what begins with # is a comment. Of several lines of one server the
/// last counts.
class KnownServers {
 public:
  explicit KnownServers(std::string path) : path_(std::move(path)) {}

  /// The fingerprint of this server; none when it is not known. An error when the file cannot be
  /// read, or has another form: then nobody is trusted.
  Result<std::optional<std::string>> Find(const std::string& server) const;

  /// Adds a line; makes the file (mode 0600) and its folders where they are missing.
  Result<void> Add(const std::string& server, const std::string& fingerprint) const;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Where the files of TLS are. Each is empty if there is not even a home folder.

/// A server's own key and certificate: "identity.pem" in $STATE_DIRECTORY (set by systemd), else in
/// $XDG_STATE_HOME/footing, else in ~/.local/state/footing.
std::string DefaultIdentityFile();

/// The servers that a user trusts: $FOOTING_KNOWN_SERVERS, else "known_servers" in
/// $XDG_CONFIG_HOME/footing, else in ~/.config/footing.
std::string KnownServersFile();

/// A user's own key and certificate, "client.pem" beside the known servers. There need not be any.
std::string ClientIdentityFile();

}  // namespace footing::tls
