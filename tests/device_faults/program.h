#pragma once

#include <sys/types.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace footing::device_faults {

/// A child process with its output in a file; killed with this object.
class Program {
 public:
  /// `output` gets standard output and standard error.
  Program(const std::vector<std::string>& command, const std::map<std::string, std::string>& added,
          std::string output);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  pid_t pid() const { return pid_; }
  /// The exit status of waitpid(2) once it has ended.
  std::optional<int> Ended();
  void Signal(int number);
  std::string Output() const;

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
  std::string output_;
};

}  // namespace footing::device_faults
