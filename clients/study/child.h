#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace footing::study::simulate {

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
  /// At once, without a goodbye; returns when it is gone.
  void Kill();

 private:
  explicit Child(pid_t process) : process_(process) {}
  pid_t process_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace footing::study::simulate
