#include "common/net/address.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "common/net/run_folder.h"

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

}  // namespace footing::transport
