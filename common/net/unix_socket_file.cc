#include "common/net/unix_socket_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace footing::transport {
namespace {

// Who holds a folder's lock is about to bind, which takes milliseconds: programs that are started
// together wait for each other, but for no longer than half a second.
constexpr int kLockTries = 50;
constexpr useconds_t kLockTryUs = 10'000;

/// An exclusive lock on a folder, for as long as it lives.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0) error_ = errno;
    for (int tries = 0; descriptor_ >= 0; ++tries) {
      error_ = flock(descriptor_, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
      if (error_ != EWOULDBLOCK || tries == kLockTries) break;
      usleep(kLockTryUs);
    }
  }
  ~FolderLock() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  int error() const { return error_; }

 private:
  int descriptor_;
  int error_ = 0;
};

/// 0 when somebody accepts connections there, otherwise the errno of connect(2).
int TryToConnect(const std::string& path) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return errno;
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::strncpy(name.sun_path, path.c_str(), sizeof(name.sun_path) - 1);
  const int failed =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) == 0 ? 0 : errno;
  close(descriptor);
  return failed == EAGAIN ? 0 : failed;  // Its backlog is full: it lives.
}

Result<void> ClearTheWay(const std::string& path, const std::string& address_text) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  if (!S_ISSOCK(status.st_mode)) {
    return Failure(address_text + ": the file exists and is not a socket; choose another path");
  }
  const int failed = TryToConnect(path);
  if (failed == 0) {
    return Failure(address_text +
                   " is in use by another server; stop that one or choose another address");
  }
  if (failed != ECONNREFUSED) {
    return Failure(address_text + ": cannot find out whether another server uses it (" +
                   std::strerror(failed) + "); choose another path");
  }
  unlink(path.c_str());
  return {};
}

}  // namespace

Result<void> BindWhereNobodyListens(const std::string& path, const std::string& address_text,
                                    const std::function<Result<void>()>& bind) {
  const std::size_t slash = path.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : path.substr(0, slash + 1);
  const FolderLock lock(folder);
  if (lock.error() == EWOULDBLOCK) {
    return Failure(address_text + ": another server is being started in " + folder + "; try again");
  }
  if (lock.error() != 0) {
    return Failure(address_text + ": folder " + folder + ": " + std::strerror(lock.error()) +
                   "; create it or choose another path");
  }
  if (auto cleared = ClearTheWay(path, address_text); !cleared) return cleared;
  return bind();
}

FileIdentity IdentityOf(const std::string& path) {
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) return {};
  return {status.st_dev, status.st_ino};
}

void RemoveIfStill(const std::string& path, const FileIdentity& identity) {
  const FileIdentity now = IdentityOf(path);
  if (now.inode != 0 && now.inode == identity.inode && now.device == identity.device) {
    unlink(path.c_str());
  }
}

}  // namespace footing::transport
