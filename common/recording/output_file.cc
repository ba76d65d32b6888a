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

/// Whether the path still names the open file.
bool IsAt(const std::string& path, int descriptor) {
  struct stat own, there;
  return ::fstat(descriptor, &own) == 0 && ::lstat(path.c_str(), &there) == 0 &&
         own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

}  // namespace

Result<void> CheckCreatable(const std::string& path, bool replace) {
  const Result<OutputFile> file = OutputFile::Create(path, replace);
  return file ? Result<void>() : file.error();
}

Result<OutputFile> OutputFile::Create(const std::string& path, bool replace) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_CLOEXEC;
  int descriptor = ::open(path.c_str(), kFlags | O_EXCL, 0600);
  if (descriptor >= 0) return OutputFile(path, descriptor, /*created=*/true);
  if (errno == EEXIST && !replace) return FileExists(path);
  if (errno == EEXIST) descriptor = ::open(path.c_str(), kFlags, 0600);
  if (descriptor >= 0) return OutputFile(path, descriptor, /*created=*/false);
  return CannotCreate(path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      created_(other.created_),
      begun_(other.begun_),
      empty_(other.empty_),
      failed_(other.failed_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(created_, other.created_);
  std::swap(begun_, other.begun_);
  std::swap(empty_, other.empty_);
  std::swap(failed_, other.failed_);
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  const bool vain = !begun_ || (failed_ && empty_);
  if (created_ && vain && IsAt(path_, descriptor_)) ::unlink(path_.c_str());
  ::close(descriptor_);
}

Result<void> OutputFile::Write(std::string_view bytes) {
  // EINVAL: a pipe or a device, which has nothing to empty.
  if (!std::exchange(begun_, true) && ::ftruncate(descriptor_, 0) != 0 && errno != EINVAL)
    return Failure("cannot empty " + path_ + ": " + std::strerror(errno));
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    failed_ = failed_ || written < 0;
    if (written < 0) return Failure("cannot write " + path_ + ": " + std::strerror(errno));
    empty_ = empty_ && written == 0;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> OutputFile::Sync() {
  // EINVAL: a pipe or a device, which has nothing to sync.
  if (::fdatasync(descriptor_) == 0 || errno == EINVAL) return {};
  return Failure("cannot write " + path_ + " to the disk: " + std::strerror(errno));
}

}  // namespace footing::recording
