#pragma once

#include <string>

/// Where the files of TLS are. Each is empty if there is not even a home folder.
namespace footing::tls {

/// A server's own key and certificate: "identity.pem" in $STATE_DIRECTORY (set by systemd), else in
/// $XDG_STATE_HOME/footing, else in ~/.local/state/footing.
std::string DefaultIdentityFile();

/// The servers that a user trusts: $FOOTING_KNOWN_SERVERS, else "known_servers" in
/// $XDG_CONFIG_HOME/footing, else in ~/.config/footing.
std::string KnownServersFile();

/// A user's own key and certificate, "client.pem" beside the known servers. There need not be any.
std::string ClientIdentityFile();

}  // namespace footing::tls
