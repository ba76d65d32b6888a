#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"

namespace footing::recording {

/// Whether Create() will do, asked before long work; leaves no file behind.
Result<void> CheckCreatable(const std::string& path, bool replace);

/// A new file that is written from its start to its end, readable by its owner alone: recordings
/// are people's movements. Until the first Write() an existing file keeps its contents, and a file
/// without one leaves the path as it was, as does a new file of which no byte could be written.
class OutputFile {
 public:
  /// An existing file is a usage error that says so, unless `replace`.
  static Result<OutputFile> Create(const std::string& path, bool replace);

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Hands all bytes to the kernel: they survive the end of this process. The first call empties
  /// an existing file.
  Result<void> Write(std::string_view bytes);
  /// Waits until the bytes are on the disk: they survive the loss of power.
  Result<void> Sync();

  const std::string& path() const { return path_; }
  /// No byte has been written.
  bool empty() const { return empty_; }

 private:
  OutputFile(std::string path, int descriptor, bool created)
      : path_(std::move(path)), descriptor_(descriptor), created_(created) {}

  std::string path_;
  int descriptor_ = -1;
  bool created_ = false;  ///< Did not exist before.
  bool begun_ = false;    ///< Write() was called.
  bool empty_ = true;
  bool failed_ = false;  ///< A Write() was.
};

}  // namespace footing::recording
