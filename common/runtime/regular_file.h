#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>

#include "common/base/result.h"

namespace footing::config {

/// A regular file that is open for reading. A folder, a named pipe, a device and a socket are
/// refused at once: opening them may wait for ever, and so would the program.
class RegularFile {
 public:
  /// An error is the reason alone.
  static Result<RegularFile> Open(const std::string& path);
  ~RegularFile();
  RegularFile(RegularFile&& other) noexcept;
  RegularFile& operator=(RegularFile&&) = delete;

  mode_t mode() const { return mode_; }
  std::size_t size() const { return size_; }
  /// Whether others than its owner have one of these rights, such as S_IRWXG | S_IRWXO.
  bool Allows(mode_t rights) const { return (mode_ & rights) != 0; }
  /// The first `bytes`, or all of a shorter file.
  Result<std::string> Read(std::size_t bytes) const;

 private:
  RegularFile(int descriptor, mode_t mode, std::size_t size)
      : descriptor_(descriptor), mode_(mode), size_(size) {}

  int descriptor_;
  mode_t mode_;
  std::size_t size_;
};

}  // namespace footing::config
