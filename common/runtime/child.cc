#include "common/runtime/child.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace footing::process {
namespace {

constexpr int kNotStarted = 127;

int CodeOf(int status) { return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status); }

/// In the child: becomes the program.
[[noreturn]] void Become(const std::string& path, const Child::Options& options) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int input = ::open("/dev/null", O_RDONLY);
  const int log = ::open(options.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (input < 0 || log < 0) ::_exit(kNotStarted);
  ::dup2(input, STDIN_FILENO);
  ::dup2(log, STDOUT_FILENO);
  ::dup2(log, STDERR_FILENO);
  for (const auto& [name, value] : options.environment) {
    ::setenv(name.c_str(), value.c_str(), 1);
  }
  std::vector<char*> arguments{const_cast<char*>(path.c_str())};
  for (const std::string& word : options.words) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  ::execv(path.c_str(), arguments.data());
  ::_exit(kNotStarted);
}

}  // namespace

Result<std::string> Beside(const std::string& program) {
  std::error_code error;
  const auto own = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return Failure("cannot start " + program + ": " + error.message());
  return (own.parent_path() / program).string();
}

Result<Child> Child::Start(const Options& options) {
  const auto found = options.folder.empty()
                         ? Beside(options.program)
                         : (std::filesystem::path(options.folder) / options.program).string();
  if (!found) return found.error();
  const std::string& path = *found;
  if (::access(path.c_str(), X_OK) != 0) {
    return Failure("cannot start " + path + ": " + std::strerror(errno) + "; build or install it");
  }
  const pid_t process = ::fork();
  if (process < 0) return Failure(std::string("fork: ") + std::strerror(errno));
  if (process == 0) Become(path, options);
  return Child(process);
}

Child::Child(Child&& other) noexcept
    : process_(std::exchange(other.process_, -1)), exit_code_(other.exit_code_) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(process_, other.process_);
  std::swap(exit_code_, other.exit_code_);
  return *this;
}

std::optional<int> Child::ExitCode() {
  int status = 0;
  if (!exit_code_ && process_ > 0 && ::waitpid(process_, &status, WNOHANG) == process_) {
    exit_code_ = CodeOf(status);
  }
  return exit_code_;
}

int Child::Wait() {
  if (const auto ended = ExitCode()) return *ended;
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  exit_code_ = CodeOf(status);
  return *exit_code_;
}

void Child::Kill() {
  if (process_ <= 0 || ExitCode()) return;
  ::kill(process_, SIGKILL);
  Wait();
}

TemporaryFolder::TemporaryFolder(const std::string& parent) {
  std::error_code error;
  const std::filesystem::path in =
      parent.empty() ? std::filesystem::temp_directory_path(error) : std::filesystem::path(parent);
  std::string path = (in / "footing-XXXXXX").string();
  if (::mkdtemp(path.data()) != nullptr) path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
}

std::string LastLine(const std::string& path) {
  std::ifstream in(path);
  std::string line, last;
  while (std::getline(in, line)) last = line;
  return last;
}

}  // namespace footing::process
