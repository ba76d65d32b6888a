#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

#include "common/base/result.h"

namespace footing::process {

/// Path of another program, in the folder of this one.
Result<std::string> Beside(const std::string& program);

/// Another program as a child process that never outlives this one.
class Child {
 public:
  struct Options {
    std::string program;
    std::vector<std::string> words;
    std::map<std::string, std::string> environment;  ///< Added to this process's own.
    std::string log;          ///< File of both its outputs; written from its start.
    std::string folder = {};  ///< Where the program is; empty: in the folder of this one.
  };
  static Result<Child> Start(const Options& options);

  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() { Kill(); }

  /// The exit code once it has ended, by itself or by a signal (128 + signal); does not wait.
  std::optional<int> ExitCode();
  /// The same; returns when it has ended.
  int Wait();
  /// Kills the process at once; returns when it is gone.
  void Kill();

 private:
  explicit Child(pid_t process) : process_(process) {}
  pid_t process_ = -1;
  std::optional<int> exit_code_;
};

/// An empty folder that is removed with all it holds.
class TemporaryFolder {
 public:
  /// In `parent`; empty: where the system keeps such folders, for sockets, whose paths must be
  /// short. path() is empty where none can be made.
  explicit TemporaryFolder(const std::string& parent = "");
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The last line of a text file, such as what a program said before it ended.
std::string LastLine(const std::string& path);

}  // namespace footing::process
