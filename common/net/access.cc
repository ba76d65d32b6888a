#include "common/net/access.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <sys/stat.h>
#include <unistd.h>

#include "common/net/address.h"
#include "common/net/known_servers.h"
#include "common/net/tls_context.h"
#include "common/runtime/files.h"
#include "common/runtime/log.h"

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

void WarnAndWait(timer::Timer& timer) {
  log::Warning("insecure_lan: what goes beyond this host is NOT ENCRYPTED, the token included");
  timer.After(std::chrono::hours(1), [&timer] { WarnAndWait(timer); });
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
  WarnAndWait(*timer);
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

namespace {

constexpr std::size_t kShortest = 16, kLongest = 256;
constexpr std::size_t kMostBytes = 4096;  // Only the first line counts.
constexpr double kTriesPerS = 0.2, kTries = 5;

bool IsPlain(const std::string& token) {
  for (const char c : token) {
    if (c <= ' ' || c > '~') return false;
  }
  return token.size() >= kShortest && token.size() <= kLongest;
}

/// Remedy for a file that cannot be opened.
std::string Remedy(const std::string& path) {
  if (access(path.c_str(), R_OK) == 0) return "";
  if (errno == ENOENT) {
    return "; make one on the server (openssl rand -hex 16 > FILE; chmod 600 FILE), and copy it to "
           "clients on other machines";
  }
  return errno == EACCES ? "; it must belong to the user who runs this program" : "";
}

}  // namespace

Result<std::string> ReadTokenFile(const std::string& path) {
  const auto file = config::RegularFile::Open(path);
  if (!file) return Failure("token file " + path + ": " + file.error().message + Remedy(path));
  if (file->Allows(S_IRWXG | S_IRWXO)) {
    return UsageError("token file " + path + " may be read by others; chmod 600 " + path);
  }
  const auto text = file->Read(kMostBytes);
  if (!text) return Failure("token file " + path + ": " + text.error().message);
  const std::string token = text->substr(0, text->find('\n'));
  if (!IsPlain(token)) {
    return InvalidData("token file " + path +
                       ": its first line must be 16 to 256 printable characters without blanks; "
                       "make one with: openssl rand -hex 16");
  }
  return token;
}

Result<std::string> TokenFromEnvironment() {
  const char* const path = std::getenv("FOOTING_TOKEN_FILE");
  if (path == nullptr || *path == '\0') return std::string();
  auto token = ReadTokenFile(path);
  if (token) return token;
  return Error{token.error().kind, "FOOTING_TOKEN_FILE: " + token.error().message};
}

bool IsSameSecret(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i) {
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i % b.size()]);
  }
  return difference == 0;
}

TokenBucket& TokenGuard::TriesOf(const std::string& host, std::int64_t now_ns) {
  constexpr std::size_t kMostHosts = 256;
  if (tries_.size() >= kMostHosts) {  // Those that have waited are forgotten; the rest share one.
    std::erase_if(tries_, [&](const auto& entry) {
      TokenBucket tries = entry.second;
      return tries.WaitNs(now_ns, kTries) == 0;
    });
  }
  const bool full = tries_.size() >= kMostHosts && !tries_.contains(host);
  return tries_.try_emplace(full ? "" : host, kTriesPerS, kTries).first->second;
}

TokenGuard::Verdict TokenGuard::Check(std::string_view presented, const std::string& host,
                                      std::int64_t now_ns) {
  const bool control = IsSameSecret(presented, token_) && !token_.empty();
  const bool view = IsSameSecret(presented, view_token_) && !view_token_.empty();
  if (control) return {v1::ROLE_CONTROL};
  if (view) return {v1::ROLE_VIEW};
  return {v1::ROLE_UNSPECIFIED, !TriesOf(host, now_ns).Spend(now_ns)};
}

}  // namespace footing::transport
