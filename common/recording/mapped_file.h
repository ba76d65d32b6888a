#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"

namespace footing::recording {

/// A file's bytes as they are now, mapped and not copied: a recording may be larger than memory. A
/// file that only grows meanwhile, as one being recorded does, is safe to read.
class MappedFile {
 public:
  static Result<MappedFile> Open(const std::string& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  std::string_view bytes() const { return bytes_; }

 private:
  explicit MappedFile(std::string_view bytes) : bytes_(bytes) {}

  std::string_view bytes_;
};

/// A recording, which may be cut anywhere; an error for a file that does not begin as one.
Result<MappedFile> OpenRecording(const std::string& path);

}  // namespace footing::recording
