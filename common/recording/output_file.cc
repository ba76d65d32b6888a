#include "common/recording/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

namespace footing::recording {
namespace {

Error FileExists(const std::string& path) {
  return UsageError(path + " exists; choose another name, or overwrite it with --force");
}

/// By errno.
Error CannotCreate(const std::string& path) {
  const int error = errno;
  const std::string folder = std::filesystem::path(path).parent_path();
  std::error_code ignored;
  const bool no_folder =
      error == ENOENT && !folder.empty() && !std::filesystem::exists(folder, ignored);
  return Failure("cannot create " + path + ": " + std::strerror(error) +
                 (no_folder ? "; make its folder first: mkdir -p " + folder : ""));
}

}  // namespace

Result<void> CheckCreatable(const std::string& path, bool replace) {
  const bool exists = ::access(path.c_str(), F_OK) == 0;
  if (exists && !replace) return FileExists(path);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor < 0) return CannotCreate(path);
  ::close(descriptor);
  if (!exists) ::unlink(path.c_str());
  return {};
}

Result<OutputFile> OutputFile::Create(const std::string& path, bool replace) {
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (replace ? O_TRUNC : O_EXCL);
  const int descriptor = ::open(path.c_str(), flags, 0600);
  if (descriptor >= 0) return OutputFile(path, descriptor);
  if (errno == EEXIST) return FileExists(path);
  return CannotCreate(path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> OutputFile::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return Failure("cannot write " + path_ + ": " + std::strerror(errno));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> OutputFile::Sync() {
  // EINVAL: a pipe or a device, which has nothing to sync.
  if (::fdatasync(descriptor_) == 0 || errno == EINVAL) return {};
  return Failure("cannot write " + path_ + " to the disk: " + std::strerror(errno));
}

bool OutputFile::Remove() {
  struct stat own, there;
  if (::fstat(descriptor_, &own) != 0 || ::lstat(path_.c_str(), &there) != 0) return false;
  const bool same = own.st_dev == there.st_dev && own.st_ino == there.st_ino;
  return same && S_ISREG(own.st_mode) && ::unlink(path_.c_str()) == 0;
}

}  // namespace footing::recording
