#pragma once

#include <functional>
#include <optional>
#include <string>

#include "daemon/sensor/setup/disk_writer.h"
#include "daemon/sensor/setup/storage.h"

namespace footing::setup {

/// What footingd remembers between its runs: one small JSON file per concern ("roles", "tares",
/// ...) with its version, its own name or serial, and a CRC-32 of its content. A file that is
/// truncated, damaged, of another version, or of another name is named in one line and moved aside
/// to *.damaged; a directory that cannot be written is said once, and footingd goes on in memory.
/// Nothing here is ever fatal.
class StateDirectory {
 public:
  using Say = std::function<void(const std::string& line)>;

  StateDirectory(std::string path, Say say) : path_(std::move(path)), say_(std::move(say)) {}

  /// The content last saved under this name; none if there is none, or it is refused.
  std::optional<std::string> Load(const std::string& name);
  /// Written beside, synced, then renamed: the old content or the new one, never half of it. Says
  /// what went wrong, or nothing. May be called on another thread: it changes nothing of this.
  std::string Write(const std::string& name, const std::string& content) const;
  /// How a Write() went: a directory that cannot be written is said once.
  void SayWritten(const std::string& problem);
  /// Both.
  void Save(const std::string& name, const std::string& content) {
    SayWritten(Write(name, content));
  }
  /// For content whose form its reader does not understand.
  void Refuse(const std::string& name, const std::string& why);

  const std::string& path() const { return path_; }

 private:
  std::string FileOf(const std::string& name) const;
  bool HasPlaceFor(const std::string& path) const;

  std::string path_;
  Say say_;
  bool unwritable_said_ = false;
};

/// The directory as a storage; it must outlive what is returned.
Storage StorageIn(StateDirectory& directory);
/// The same, written by the disk's thread; what waits to be written is what is loaded.
Storage StorageIn(StateDirectory& directory, DiskWriter& disk);

/// Where the state lies: `configured` if not empty, else $STATE_DIRECTORY (set by systemd), else
/// $XDG_STATE_HOME/footing, else ~/.local/state/footing. Empty if there is no home either.
std::string StatePath(const std::string& configured);

}  // namespace footing::setup
