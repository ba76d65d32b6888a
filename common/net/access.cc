#include "common/net/access.h"

#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <sstream>
#include <utility>

#include "common/runtime/regular_file.h"
#include "common/runtime/log.h"
#include "common/net/fingerprint.h"
#include "common/net/identity.h"
#include "common/net/places.h"
#include "common/net/exposure.h"
#include "common/net/token.h"

namespace footing::transport {
namespace {

constexpr std::array<std::pair<const char*, v1::Role>, 3> kRoles{
    {{"view", v1::ROLE_VIEW}, {"log", v1::ROLE_LOG}, {"control", v1::ROLE_CONTROL}}};

constexpr std::size_t kMostClientsBytes = 4u << 20;

v1::Role RoleNamed(const std::string& name) {
  for (const auto& [known, role] : kRoles) {
    if (name == known) return role;
  }
  return v1::ROLE_UNSPECIFIED;
}

void WarnAndWait(const std::shared_ptr<timer::Timer>& timer) {
  log::Warning("insecure_lan: what goes beyond this host is NOT ENCRYPTED, the token included");
  timer->expires_after(std::chrono::hours(1));
  timer->async_wait([weak = std::weak_ptr(timer)](const boost::system::error_code& error) {
    const auto still_there = weak.lock();
    if (!error && still_there) WarnAndWait(still_there);
  });
}

/// Who may write the file may let anybody in.
Result<std::map<std::string, v1::Role>> ReadClients(const std::string& path) {
  const auto file = config::RegularFile::Open(path);
  if (!file) return Failure("clients file " + path + ": " + file.error().message);
  if (file->Allows(S_IWGRP | S_IWOTH)) {
    return UsageError("clients file " + path + " may be written by others; chmod go-w " + path);
  }
  if (file->size() > kMostClientsBytes) {
    return InvalidData("clients file " + path + " has more than " +
                       std::to_string(kMostClientsBytes) + " bytes");
  }
  const auto text = file->Read(kMostClientsBytes);
  if (!text) return Failure("clients file " + path + ": " + text.error().message);
  auto clients = ParseClients(*text);
  if (!clients) return InvalidData(path + ", " + clients.error().message);
  return clients;
}

}  // namespace

void AccessSettings::Bind(config::Binder& binder) {
  binder.Text(
      "token_file", token_file,
      "File (mode 0600) with a token by which clients over TCP and TLS get the role control");
  binder.Text("view_token_file", view_token_file,
              "File (mode 0600) with another token, by which such clients get the role view");
  binder.Text(
      "clients_file", clients_file,
      "File with the certificates of clients over TLS, lines \"sha256:... ROLE [NAME]\" with "
      "the role view, log or control; only its owner may be able to write it");
  binder.Text(
      "identity_file", identity_file,
      "File (mode 0600) with this server's key and certificate for TLS, made where it is "
      "missing; empty: identity.pem in state_directory (footingd), else in $STATE_DIRECTORY, else "
      "in $XDG_STATE_HOME/footing, else in ~/.local/state/footing");
  binder.Flag(
      "insecure_lan", insecure_lan,
      "Listen on tcp: beyond this host WITHOUT ENCRYPTION; needs token_file or view_token_file");
  binder.Text(
      "advertise", advertise,
      "Name under which footing-ctl discover finds this server, while it listens beyond this "
      "host; by avahi-daemon (empty: not advertised)");
}

Result<void> AccessSettings::Check() const {
  if (insecure_lan && token_file.empty() && view_token_file.empty()) {
    return UsageError("config: insecure_lan needs a token_file or a view_token_file");
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
  if (!view_token_file.empty()) {
    auto token = ReadTokenFile(view_token_file);
    if (!token) return token.error();
    options.view_token = std::move(token).value();
    if (options.view_token == options.token) {
      return UsageError("token_file " + token_file + " and view_token_file " + view_token_file +
                        " have the same token; make another one with: openssl rand -hex 16");
    }
  }
  if (!clients_file.empty()) {
    auto clients = ReadClients(clients_file);
    if (!clients) return clients.error();
    options.clients = std::move(clients).value();
  }
  options.identity_file = identity_file.empty() ? tls::DefaultIdentityFile() : identity_file;
  options.insecure_lan = insecure_lan;
  return {};
}

Result<void> AccessSettings::CheckStart(const std::vector<std::string>& listen) const {
  ServerOptions options;
  if (auto applied = Apply(options); !applied) return applied;
  for (const std::string& text : listen) {
    const auto address = ParseAddress(text);
    if (!address) return address.error();
    if (auto clear = CheckEncrypted(*address, insecure_lan && options.has_token()); !clear) {
      return clear;
    }
    if (address->kind != Address::Kind::kTls) continue;
    if (auto keys = CheckKeys(*address, options.has_keys()); !keys) return keys;
    const std::string& identity = *options.identity_file;
    if (access(identity.c_str(), F_OK) != 0 && errno == ENOENT) continue;  // The start makes it.
    if (auto loaded = tls::Identity::Load(identity); !loaded) return loaded.error();
  }
  return {};
}

Result<std::vector<std::string>> AccessSettings::Reapply(Server& server) const {
  ServerOptions read;
  if (const auto applied = Apply(read); !applied) return applied.error();
  const ServerOptions& before = server.options();
  std::vector<std::string> changed;
  if (read.token != before.token) changed.push_back("token_file");
  if (read.view_token != before.view_token) changed.push_back("view_token_file");
  if (read.clients != before.clients) changed.push_back("clients_file");
  if (const std::size_t ended = server.SetAccess(read); ended > 0) {
    log::Info("sessions ended, since their token or certificate was replaced or removed: " +
              std::to_string(ended));
  }
  return changed;
}

std::shared_ptr<timer::Timer> WarnOfInsecureLan(boost::asio::io_context& io) {
  auto timer = std::make_shared<timer::Timer>(io);
  WarnAndWait(timer);
  return timer;
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
          ": it must be a certificate's fingerprint sha256:... and a role: view, log or control");
    }
    clients[*fingerprint] = role;
  }
  return clients;
}

}  // namespace footing::transport
