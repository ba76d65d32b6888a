#include "common/runtime/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace footing::config {
namespace {

const char* KindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISSOCK(mode)) return "a socket";
  return "a device";
}

Error NotRegular(mode_t mode) {
  return Failure(std::string("it is ") + KindOf(mode) + ", not a regular file");
}

}  // namespace

Result<RegularFile> RegularFile::Open(const std::string& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) != 0) return Failure(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return NotRegular(status.st_mode);
  // It may have been replaced since: without O_NONBLOCK a pipe would wait for its writer.
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return Failure(std::strerror(errno));
  const bool known = fstat(descriptor, &status) == 0;
  RegularFile file(descriptor, status.st_mode, static_cast<std::size_t>(status.st_size));
  if (!known || !S_ISREG(status.st_mode)) return NotRegular(status.st_mode);
  return file;
}

RegularFile::~RegularFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

RegularFile::RegularFile(RegularFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), mode_(other.mode_), size_(other.size_) {}

Result<std::string> RegularFile::Read(std::size_t bytes) const {
  std::string text(std::min(bytes, size_), '\0');
  std::size_t have = 0;
  while (have < text.size()) {
    const ssize_t got =
        pread(descriptor_, text.data() + have, text.size() - have, static_cast<off_t>(have));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Failure(std::strerror(errno));
    if (got == 0) return Failure("it was cut short while it was read");
    have += static_cast<std::size_t>(got);
  }
  return text;
}

}  // namespace footing::config
