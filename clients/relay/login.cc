#include "clients/relay/login.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <sys/stat.h>

#include "common/net/socket.h"

namespace footing::relay {
namespace {

/// A line of the file as it may be sent: not empty, printable, not too long.
bool IsSecret(const std::string& line) {
  constexpr std::size_t kLongest = 1024;
  return !line.empty() && line.size() <= kLongest &&
         std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

Result<nats::Login> ReadLoginFile(const std::string& path) {
  if (path.empty()) return nats::Login{};
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    return Failure("login file " + path + ": " + std::strerror(errno));
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return UsageError("login file " + path + " may be read by others; chmod 600 " + path);
  }
  std::ifstream file(path);
  std::string first, second;
  std::getline(file, first);
  const bool two = static_cast<bool>(std::getline(file, second)) && !second.empty();
  if (!IsSecret(first) || (two && !IsSecret(second))) {
    return InvalidData("login file " + path +
                       ": it must have one line with a token, or two with a user and a password");
  }
  nats::Login login;
  if (two) {
    login.user = first;
    login.password = second;
  } else {
    login.token = first;
  }
  return login;
}

Result<transport::Address> ParseBrokerAddress(const std::string& text, const std::string& instead) {
  const bool named = text.starts_with("tcp:") || text.starts_with("tls:") ||
                     text.starts_with("unix:") || text.starts_with("fd:");
  auto address = transport::ParseAddress(named ? text : "tcp:" + text);
  if (!address) return UsageError("\"" + text + "\" is not a broker's address, [tcp:]HOST:PORT");
  if (address->kind != transport::Address::Kind::kTcp) {
    return UsageError(text + ": a broker is dialled at tcp:HOST:PORT");
  }
  if (const auto endpoint = transport::EndpointOf(*address); !endpoint) return endpoint.error();
  if (!transport::StaysOnThisHost(*address)) {
    return UsageError(text + ": would leave this host unencrypted; " + instead);
  }
  return address;
}

}  // namespace footing::relay
