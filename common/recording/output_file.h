#pragma once

#include <string>
#include <string_view>

#include "common/result/result.h"

namespace footing::recording {

/// Whether Create() will do, asked before long work; leaves no file behind.
Result<void> CheckCreatable(const std::string& path, bool replace);

/// A new file that is written from its start to its end, readable by its owner alone: recordings
/// are people's movements.
class OutputFile {
 public:
  /// An existing file is a usage error that says so, unless `replace`.
  static Result<OutputFile> Create(const std::string& path, bool replace);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Hands all bytes to the kernel: they survive the end of this process.
  Result<void> Write(std::string_view bytes);
  /// Waits until the bytes are on the disk: they survive the loss of power.
  Result<void> Sync();
  /// Removes the file; false where its path is not, or no longer, this very file: a device, or a
  /// link to another place.
  bool Remove();

  const std::string& path() const { return path_; }

 private:
  OutputFile(std::string path, int descriptor) : path_(std::move(path)), descriptor_(descriptor) {}

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace footing::recording
