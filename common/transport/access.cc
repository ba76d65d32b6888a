#include "common/transport/access.h"

#include <array>
#include <sstream>
#include <utility>

#include "common/config/data_file.h"
#include "common/tls/fingerprint.h"
#include "common/tls/places.h"
#include "common/transport/token.h"

namespace footing::transport {
namespace {

constexpr std::array<std::pair<const char*, v1::Role>, 3> kRoles{
    {{"view", v1::ROLE_VIEW}, {"log", v1::ROLE_LOG}, {"control", v1::ROLE_CONTROL}}};

v1::Role RoleNamed(const std::string& name) {
  for (const auto& [known, role] : kRoles) {
    if (name == known) return role;
  }
  return v1::ROLE_UNSPECIFIED;
}

}  // namespace

void AccessSettings::Bind(config::Binder& binder) {
  binder.Text(
      "token_file", token_file,
      "File (mode 0600) with a token by which clients over TCP and TLS get the role control");
  binder.Text("clients_file", clients_file,
              "File with the certificates of clients over TLS, lines \"sha256:... ROLE NAME\" with "
              "the role view, log or control");
  binder.Text(
      "identity_file", identity_file,
      "File (mode 0600) with this server's key and certificate for TLS, made where it is "
      "missing; empty: identity.pem in $STATE_DIRECTORY, else $XDG_STATE_HOME/footing, else "
      "~/.local/state/footing");
  binder.Flag("insecure_lan", insecure_lan,
              "Listen on tcp: beyond this host WITHOUT ENCRYPTION; needs token_file");
  binder.Text(
      "advertise", advertise,
      "Name under which footing-ctl discover finds this server, while it listens beyond this "
      "host; by avahi-daemon (empty: not advertised)");
}

Result<void> AccessSettings::Check() const {
  if (insecure_lan && token_file.empty()) {
    return UsageError("config: insecure_lan needs a token_file");
  }
  constexpr std::size_t kLongestName = 63;  // RFC 6763, 4.1.1.
  if (advertise.size() > kLongestName) return UsageError("config: advertise has at most 63 bytes");
  return {};
}

Result<void> AccessSettings::Apply(ServerOptions& options) const {
  if (auto checked = Check(); !checked) return checked;
  if (!token_file.empty()) {
    auto token = ReadTokenFile(token_file);
    if (!token) return token.error();
    options.token = std::move(token).value();
  }
  if (!clients_file.empty()) {
    const auto text = config::ReadTextFile(clients_file);
    if (!text) return text.error();
    auto clients = ParseClients(*text);
    if (!clients) return InvalidData(clients_file + ", " + clients.error().message);
    options.clients = std::move(clients).value();
  }
  options.identity_file = identity_file.empty() ? tls::DefaultIdentityFile() : identity_file;
  options.insecure_lan = insecure_lan;
  return {};
}

Result<std::map<std::string, v1::Role>> ParseClients(const std::string& text) {
  std::map<std::string, v1::Role> clients;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::string fingerprint_text, role_name;
    if (!(words >> fingerprint_text) || fingerprint_text.front() == '#') continue;
    words >> role_name;
    const auto fingerprint = tls::ParseFingerprint(fingerprint_text);
    const v1::Role role = RoleNamed(role_name);
    if (!fingerprint || role == v1::ROLE_UNSPECIFIED) {
      return InvalidData(
          "line " + std::to_string(number) +
          ": it must be a certificate's fingerprint sha256:..., a role (view, log or "
          "control) and a name");
    }
    clients[*fingerprint] = role;
  }
  return clients;
}

}  // namespace footing::transport
