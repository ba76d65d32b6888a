#include "common/net/address.h"

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include <sys/stat.h>
#include <unistd.h>

#include "common/net/socket.h"

namespace footing::transport {
namespace {

Error NotAnAddress(const std::string& text, const std::string& why) {
  return UsageError("\"" + text + "\" is not an address: " + why +
                    "; write unix:PATH, tcp:HOST:PORT or tls:HOST:PORT, for example "
                    "tcp:127.0.0.1:7450");
}

Result<Address> ParseUnix(const std::string& text, const std::string& path) {
  constexpr std::size_t kMaxPathBytes = 107;  // sockaddr_un in unix(7).
  if (path.empty()) return NotAnAddress(text, "the path is missing");
  if (path.size() > kMaxPathBytes) {
    return NotAnAddress(text, "a Unix socket's path has at most 107 bytes, this one has " +
                                  std::to_string(path.size()));
  }
  Address address;
  address.kind = Address::Kind::kUnix;
  address.path = path;
  return address;
}

Result<Address> ParseTcp(const std::string& text, const std::string& rest, Address::Kind kind) {
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string::npos) return NotAnAddress(text, "the port is missing");
  std::string host = rest.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  if (host.empty()) return NotAnAddress(text, "the host is missing");
  const char* const begin = rest.data() + colon + 1;
  const char* const end = rest.data() + rest.size();
  Address address;
  const auto [stop, error] = std::from_chars(begin, end, address.port);
  if (begin == end || error != std::errc() || stop != end) {
    return NotAnAddress(text, "the port must be a number from 0 to 65535");
  }
  address.kind = kind;
  address.host = host;
  return address;
}

}  // namespace

std::string Address::Text() const {
  if (kind == Kind::kUnix) return "unix:" + path;
  if (kind == Kind::kPassed) return "fd:" + path;
  const bool version6 = host.find(':') != std::string::npos;
  return (kind == Kind::kTls ? "tls:" : "tcp:") + (version6 ? "[" + host + "]" : host) + ":" +
         std::to_string(port);
}

Result<Address> ParseAddress(const std::string& text) {
  if (text.rfind("unix:", 0) == 0) return ParseUnix(text, text.substr(5));
  if (text.rfind("tcp:", 0) == 0) return ParseTcp(text, text.substr(4), Address::Kind::kTcp);
  if (text.rfind("tls:", 0) == 0) return ParseTcp(text, text.substr(4), Address::Kind::kTls);
  if (text.rfind("fd:", 0) == 0) {
    Address address;
    address.kind = Address::Kind::kPassed;
    address.path = text.substr(3);
    if (address.path.empty()) return NotAnAddress(text, "the name of the passed socket is missing");
    return address;
  }
  return NotAnAddress(text, "it begins with none of unix:, tcp: and tls:");
}

Address DefaultAddress(const std::string& name, bool create) {
  const std::string folder = RunFolder();
  // A folder that cannot be made, or is not ours alone, shows when the listener binds, with its
  // reason.
  if (create) mkdir(folder.c_str(), S_IRWXU);
  Address address;
  address.path = folder + "/" + name + ".sock";
  const std::string of_service = "/run/footing/" + name + ".sock";
  if (!create && access(address.path.c_str(), F_OK) != 0 && access(of_service.c_str(), F_OK) == 0) {
    address.path = of_service;
  }
  return address;
}

Result<void> CheckKeys(const Address& address, bool has_keys, const ListenSettings& settings) {
  if (has_keys) return {};
  return UsageError("will not listen on " + address.Text() +
                    ": anyone who reaches the port could come in; " + settings.keys);
}

Result<void> CheckEncrypted(const Address& address, bool in_clear, const ListenSettings& settings) {
  if (address.kind != Address::Kind::kTcp || StaysOnThisHost(address) || in_clear) return {};
  return UsageError("will not listen on " + address.Text() +
                    ": beyond this host a connection must be encrypted; use tls:HOST:PORT, or, in "
                    "a network that you trust wholly, " +
                    settings.in_clear);
}

namespace {

constexpr const char* kFolderOfService = "/run/footing";
constexpr const char* kJoinGroup =
    "; join the group that owns the socket, footing for that of the service: sudo usermod -aG "
    "footing $USER, then log in again (docs/setup.md)";

Error Unsafe(const std::string& folder, const std::string& why) {
  return Failure(
      "folder " + folder + " " + why +
      ", so a socket in it may be anybody's: remove it, or set XDG_RUNTIME_DIR to a folder "
      "of your own");
}

}  // namespace

std::string FallbackRunFolder() { return "/tmp/footing-" + std::to_string(geteuid()); }

std::string RunFolder() {
  const char* const runtime = std::getenv("XDG_RUNTIME_DIR");
  const bool usable = runtime != nullptr && *runtime == '/';
  return usable ? std::string(runtime) + "/footing" : FallbackRunFolder();
}

void MakeRunFolderFor(const Address& address) {
  const std::string folder = RunFolder();
  const bool in_it =
      address.kind == Address::Kind::kUnix && address.path.rfind(folder + "/", 0) == 0;
  if (in_it) mkdir(folder.c_str(), S_IRWXU);
}

Result<void> CheckRunFolder(const std::string& folder, uid_t own_user) {
  struct stat status {};
  if (lstat(folder.c_str(), &status) != 0) return {};  // Nobody's yet.
  if (!S_ISDIR(status.st_mode)) return Unsafe(folder, "is a link or a file");
  if (status.st_uid != own_user) {
    return Unsafe(folder, "belongs to user " + std::to_string(status.st_uid));
  }
  if ((status.st_mode & (S_IWGRP | S_IWOTH)) != 0) return Unsafe(folder, "is writable by others");
  return {};
}

Result<void> CheckFolderOf(const Address& address) {
  const std::string folder = FallbackRunFolder();
  const bool in_it =
      address.kind == Address::Kind::kUnix && address.path.rfind(folder + "/", 0) == 0;
  return in_it ? CheckRunFolder(folder, geteuid()) : Result<void>();
}

std::string RemedyFor(const std::string& why, const std::string& otherwise) {
  const auto says = [&](const char* words) { return why.find(words) != std::string::npos; };
  if (says(kJoinGroup)) return "";
  // Outside the group not even the names of the service's sockets can be seen, so the address is
  // that of a server of one's own, which is missing.
  const bool service_is_closed =
      access(kFolderOfService, F_OK) == 0 && access(kFolderOfService, X_OK) != 0;
  if (says("permission denied") || (says("no such file") && service_is_closed)) return kJoinGroup;
  return otherwise.empty() ? "" : "; " + otherwise;
}

}  // namespace footing::transport
