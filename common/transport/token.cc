#include "common/transport/token.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <utility>

namespace footing::transport {
namespace {

constexpr std::size_t kShortest = 16, kLongest = 256;
constexpr double kTriesPerS = 0.2, kTries = 5;

bool IsPlain(const std::string& token) {
  for (const char c : token) {
    if (c <= ' ' || c > '~') return false;
  }
  return token.size() >= kShortest && token.size() <= kLongest;
}

}  // namespace

Result<std::string> ReadTokenFile(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) {
    const std::string remedy =
        errno == ENOENT ? "; make one on the server (openssl rand -hex 16 > FILE; chmod 600 FILE), "
                          "and copy it to clients on other machines"
                        : "";
    return Failure("token file " + path + ": " + std::strerror(errno) + remedy);
  }
  if ((status.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return UsageError("token file " + path + " may be read by others; chmod 600 " + path);
  }
  std::ifstream file(path);
  if (!file) {
    return Failure("token file " + path + ": " + std::strerror(errno) +
                   "; it must belong to the user who runs this program");
  }
  std::string token;
  std::getline(file, token);
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

bool TokenGuard::Accepts(std::string_view presented, const std::string& host, std::int64_t now_ns) {
  if (token_.empty()) return false;
  TokenBucket& tries = TriesOf(host, now_ns);
  if (!tries.HasOne(now_ns)) return false;
  if (IsSameSecret(presented, token_)) return true;
  tries.Charge(1);
  return false;
}

}  // namespace footing::transport
