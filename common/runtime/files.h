#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include <sys/types.h>

#include "common/base/result.h"

namespace footing::config {

/// Where a built-in file is: `folder` if given, then the install folder
/// (PREFIX/share/footing), then the source tree (daemon/simulation/data). An error names all
/// places.
Result<std::string> FindDataFile(const std::string& name, const std::string& folder = "");

/// The whole text of a regular file of at most `max_bytes` (RegularFile).
Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes = 4u << 20);

/// The file at a path (it has a / or ends in .json), otherwise the built-in file
/// "FOLDER/NAME.json". The error for an unknown name lists the names that there are.
Result<std::string> ReadNamedOrPath(const std::string& name_or_path, const std::string& folder,
                                    const std::string& data_folder = "");
/// The built-in file "FOLDER/NAME.json" alone; the same error.
Result<std::string> ReadNamed(const std::string& name, const std::string& folder,
                              const std::string& data_folder = "");

/// FindDataFile, then ReadTextFile.
Result<std::string> ReadDataFile(const std::string& name, const std::string& folder = "");

/// Owns an open file, socket or other descriptor.
class FileDescriptor {
 public:
  /// A negative number is none.
  explicit FileDescriptor(int number = -1) : number_(number) {}
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~FileDescriptor();

  int number() const { return number_; }
  bool is_open() const { return number_ >= 0; }

 private:
  int number_;
};

/// A regular file that is open for reading. A folder, a named pipe, a device and a socket are
/// refused at once: opening them may wait for ever, and so would the program.
class RegularFile {
 public:
  /// An error is the reason alone.
  static Result<RegularFile> Open(const std::string& path);

  mode_t mode() const { return mode_; }
  std::size_t size() const { return size_; }
  /// Whether others than its owner have one of these rights, such as S_IRWXG | S_IRWXO.
  bool Allows(mode_t rights) const { return (mode_ & rights) != 0; }
  /// The first `bytes`, or all of a shorter file.
  Result<std::string> Read(std::size_t bytes) const;

 private:
  RegularFile(FileDescriptor file, mode_t mode, std::size_t size)
      : file_(std::move(file)), mode_(mode), size_(size) {}

  FileDescriptor file_;
  mode_t mode_;
  std::size_t size_;
};

/// The folders above a file, made where they are missing (mode 0700). An error names the folder.
Result<void> MakeFoldersAbove(const std::string& path);

/// Writes the folder of a file to the disk, so that the file's name survives the loss of power.
/// Some file systems cannot.
void SyncFolderOf(const std::string& path);

/// Replaces the content of a file, on the disk before this returns: written beside, synced, then
/// renamed, so that a reader finds the old content or the new one, never half of it. An existing
/// file keeps its mode and, where this user may give it away, its owner; of a symbolic link the
/// target is replaced. A new file has mode 0600. An error is the system's reason alone.
Result<void> ReplaceFile(const std::string& path, const std::string& text);

}  // namespace footing::config
