#include "common/net/places.h"

#include <cstdlib>

namespace footing::tls {
namespace {

std::string Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// The file in the folder of Footing: below $`variable` if set, else below ~/`in_home`.
std::string FootingFile(const char* variable, const std::string& in_home, const std::string& file) {
  const std::string xdg = Variable(variable);
  if (!xdg.empty()) return xdg + "/footing/" + file;
  const std::string home = Variable("HOME");
  return home.empty() ? "" : home + "/" + in_home + "/footing/" + file;
}

}  // namespace

std::string DefaultIdentityFile() {
  const std::string systemd = Variable("STATE_DIRECTORY");
  if (!systemd.empty()) return systemd.substr(0, systemd.find(':')) + "/identity.pem";
  return FootingFile("XDG_STATE_HOME", ".local/state", "identity.pem");
}

std::string KnownServersFile() {
  const std::string named = Variable("FOOTING_KNOWN_SERVERS");
  return named.empty() ? FootingFile("XDG_CONFIG_HOME", ".config", "known_servers") : named;
}

std::string ClientIdentityFile() {
  const std::string known = KnownServersFile();
  return known.empty() ? "" : known.substr(0, known.rfind('/') + 1) + "client.pem";
}

}  // namespace footing::tls
