#include "common/net/token.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <utility>

#include "common/runtime/regular_file.h"

namespace footing::transport {
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

/// What to do about a file that cannot be opened.
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
  return {v1::ROLE_UNSPECIFIED, !TriesOf(host, now_ns).Take(now_ns)};
}

}  // namespace footing::transport
