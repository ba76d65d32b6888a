#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <thread>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>

#include "daemon/sensor/setup/setup_store.h"

namespace footing::setup {

/// Writes named texts on a thread of its own, so that the io thread never waits for a disk. One is
/// being written at a time, in the order they were first saved; a text that is saved again while it
/// waits replaces the one that waits, so that no flood of them makes a queue. Everything but
/// `write` runs on the io_context's one thread.
class DiskWriter {
 public:
  /// `write` is called on the disk's thread and says what went wrong, or nothing; `on_result` gets
  /// that of each write.
  using Write = std::function<std::string(const std::string& name, const std::string& content)>;
  DiskWriter(boost::asio::io_context& io, Write write,
             std::function<void(const std::string& problem)> on_result);
  /// Writes what waits.
  ~DiskWriter();
  DiskWriter(const DiskWriter&) = delete;
  DiskWriter& operator=(const DiskWriter&) = delete;

  void Save(const std::string& name, const std::string& content);

  /// Content saved under this name and not written yet.
  std::optional<std::string> Waiting(const std::string& name) const;

  /// The number of the last Save(), from 1; 0 before.
  std::uint64_t last_save() const { return last_save_; }

  /// Calls `done`, from the loop, when everything saved so far is written; `problem` is that of the
  /// last write that failed since, or empty.
  void OnWritten(std::function<void(const std::string& problem)> done);

 private:
  struct Text {
    std::string name;
    std::string content;
    std::uint64_t first_save = 0;  ///< The oldest Save() that it answers.
  };
  struct Waiter {
    std::uint64_t save = 0;
    std::string problem;
    std::function<void(const std::string&)> done;
  };

  void WriteNext();
  void OnResult(const std::string& problem);
  void CallDone();

  boost::asio::io_context& io_;
  const Write write_;
  const std::function<void(const std::string&)> on_result_;
  std::deque<Text> waiting_;  ///< The first one is being written while writing_.
  bool writing_ = false;
  std::uint64_t last_save_ = 0;
  std::deque<Waiter> waiters_;
  boost::asio::io_context disk_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  ///< Asked on the io thread only.
  std::thread thread_;
};

/// State that footingd keeps between its runs: one small JSON file per concern ("roles", "tares",
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
