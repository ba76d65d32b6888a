#include "common/runtime/write_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace footing::config {
namespace {

/// Zero, or the error.
int WriteAndSync(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t wrote = write(file, text.data(), text.size());
    if (wrote < 0 && errno != EINTR) return errno;
    if (wrote > 0) text.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return fsync(file) == 0 ? 0 : errno;
}

/// Mode and owner of the file at `path`, if there is one.
int CopyRights(const std::string& path, int file) {
  struct stat old {};
  if (stat(path.c_str(), &old) != 0) return 0;
  // Only root may give a file away; another user's copy is that user's.
  [[maybe_unused]] const int owned = fchown(file, old.st_uid, old.st_gid);
  constexpr mode_t kRights = S_IRWXU | S_IRWXG | S_IRWXO;
  return fchmod(file, old.st_mode & kRights) == 0 ? 0 : errno;
}

/// The rename itself; some file systems cannot, and the file is whole anyway.
void SyncFolderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path();
  const int directory =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return;
  fsync(directory);
  close(directory);
}

}  // namespace

Result<void> MakeFoldersAbove(const std::string& path) {
  for (std::size_t slash = path.find('/', 1); slash != std::string::npos;
       slash = path.find('/', slash + 1)) {
    const std::string folder = path.substr(0, slash);
    if (mkdir(folder.c_str(), S_IRWXU) == 0) continue;
    const int error = errno;
    // A folder that is there may stand in one that is not to be written.
    if (struct stat there{}; stat(folder.c_str(), &there) == 0 && S_ISDIR(there.st_mode)) continue;
    return Failure("cannot make the folder " + folder + ": " + std::strerror(error));
  }
  return {};
}

Result<void> ReplaceFile(const std::string& path, const std::string& text) {
  std::error_code not_there;
  const std::string target = std::filesystem::canonical(path, not_there);
  const std::string& final_path = not_there ? path : target;
  const std::string beside = final_path + ".new";
  unlink(beside.c_str());  // Of a program that was ended in the middle.
  const int file = open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (file < 0) return Failure(std::strerror(errno));
  int error = CopyRights(final_path, file);
  if (error == 0) error = WriteAndSync(file, text);
  if (close(file) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(beside.c_str(), final_path.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(beside.c_str());
    return Failure(std::strerror(error));
  }
  SyncFolderOf(final_path);
  return {};
}

}  // namespace footing::config
