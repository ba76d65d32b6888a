#include "common/net/run_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>

namespace footing::transport {
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
